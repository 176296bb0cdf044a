// Handhold in C#: what is not generated. Ownership of worlds and meshes, errors as exceptions, inputs, and surfaces of a host with physics of its
// own; HandholdMatch.cs has matches. Names, units and defaults are those of the C headers; methods of a World are the functions hh_world_x as X,
// and hh_body_x as BodyX.
using System;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;
using System.Text;
#if UNITY_5_3_OR_NEWER
using AOT;
#endif

namespace Handhold {
    /// <summary>A call that the library refused. It has changed nothing.</summary>
    public class HandholdException : Exception {
        public readonly Result Result;
        public HandholdException(Result result, string text) : base(text) { Result = result; }
    }

    /// <summary>uint8_t of the C interface: 0 is false.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Flag {
        private byte value;
        public static implicit operator bool(Flag flag) => flag.value != 0;
        public static implicit operator Flag(bool value) => new Flag { value = (byte)(value ? 1 : 0) };
        public override string ToString() => value != 0 ? "true" : "false";
    }

    public partial struct HhPose {
        public HhPose(Vec3 position, Quat rotation) {
            this.position = position;
            this.rotation = rotation;
        }
        public HhPose(Vec3 position) : this(position, new Quat(0, 0, 0, 1)) { }
        /// <summary>The pose at the origin, not rotated.</summary>
        public static HhPose Identity => new HhPose(new Vec3(0, 0, 0));
    }

    /// <summary>Functions without a world.</summary>
    public static unsafe partial class Library {
        // Callbacks of this thread: how many are running, and the first exception since the last call of the library ended.
        [ThreadStatic] private static int running;
        [ThreadStatic] private static ExceptionDispatchInfo thrown;

        /// <summary>Throws what a callback has thrown, and for all results but Result.Ok.</summary>
        public static void Check(Result result) {
            if (thrown != null) {
                ExceptionDispatchInfo first = thrown;
                thrown = null;
                first.Throw();
            }
            if (result != Result.Ok) {
                throw new HandholdException(result, Text(Native.hh_result_text(result)) + ": " + Text(Native.hh_last_error()));
            }
        }
        /// <summary>Begins and ends a function that the library calls. Its exceptions must not cross the library: Failed keeps them for Check.</summary>
        internal static void BeginCallback() { ++running; }
        internal static void EndCallback() { --running; }
        internal static byte Failed(Exception error) {
            thrown = thrown ?? ExceptionDispatchInfo.Capture(error);
            return 0;
        }
        internal static void RefuseInCallback(string what) {
            if (running > 0) {
                throw new HandholdException(Result.ErrorState, "HH_ERROR_STATE: " + what + " cannot be disposed inside a callback");
            }
        }
        private static Version supported;
        /// <summary>Throws if the library is of another minor version: before 1.0.0 each may change the interface.</summary>
        internal static void RequireVersion() {
            if (supported != null) {
                return;
            }
            uint major, minor, patch;
            Native.hh_version(&major, &minor, &patch);
            if (major != Constants.HandholdVersionMajor || minor != Constants.HandholdVersionMinor) {
                throw new HandholdException(Result.ErrorVersion, "the library has version " + major + "." + minor + "; the C# code is of " + Constants.HandholdVersionText);
            }
            supported = new Version((int)major, (int)minor);
        }

        private static Action<LogLevel, string> log;
        private static readonly HostHooksLog logCallback = Log;

        /// <summary>The library's log goes to `heard` from now on; null: there is no log. HH_ERROR_STATE while a world exists.
        /// Other hooks are reset. `heard` may be called by any thread that calls the library.</summary>
        public static void SetLog(Action<LogLevel, string> heard) {
            RequireVersion();
            HostHooks hooks = HostHooks.Default();
            hooks.log = heard == null ? IntPtr.Zero : Marshal.GetFunctionPointerForDelegate(logCallback);
            Check(Native.hh_set_host_hooks(heard == null ? null : &hooks));
            log = heard;
        }
        [MonoPInvokeCallback(typeof(HostHooksLog))]
        private static void Log(IntPtr context, LogLevel level, byte* message) {
            BeginCallback();
            try {
                log?.Invoke(level, Text(message));
            } catch (Exception error) {
                Failed(error);
            } finally {
                EndCallback();
            }
        }

        internal static void RequireLength(Array list, int length, string name) {
            if (list == null || list.Length != length) {
                throw new ArgumentException(name + ": " + length + " elements are needed");
            }
        }
        internal static UIntPtr Count(Array list) => (UIntPtr)(uint)(list == null ? 0 : list.Length);
        /// <summary>A text with its final 0; null stays null.</summary>
        internal static byte[] Text(string text) {
            if (text == null) {
                return null;
            }
            byte[] bytes = new byte[Encoding.UTF8.GetByteCount(text) + 1];
            Encoding.UTF8.GetBytes(text, 0, text.Length, bytes, 0);
            return bytes;
        }
        /// <summary>Texts one after the other; null: none.</summary>
        internal static byte[] Texts(string[] texts, Array elements, string name) {
            if (texts == null) {
                return null;
            }
            RequireLength(texts, elements == null ? 0 : elements.Length, name);
            using (System.IO.MemoryStream bytes = new System.IO.MemoryStream()) {
                foreach (string text in texts) {
                    bytes.Write(Text(text) ?? new byte[0], 0, Size(text));
                }
                return bytes.ToArray();
            }
        }
        /// <summary>Bytes of Text(text).</summary>
        internal static int Size(string text) => text == null ? 0 : Encoding.UTF8.GetByteCount(text) + 1;
        /// <summary>A copy whose texts can be set.</summary>
        internal static T[] Copy<T>(T[] elements) => elements == null ? null : (T[])elements.Clone();
        /// <summary>A text of the library, such as TuningInfo.name.</summary>
        public static string Text(byte* at) {
            if (at == null) {
                return null;
            }
            int size = 0;
            while (at[size] != 0) {
                ++size;
            }
            byte[] bytes = new byte[size];
            Marshal.Copy((IntPtr)at, bytes, 0, size);
            return Encoding.UTF8.GetString(bytes);
        }
    }

    /// <summary>Triangles for shapes and surfaces: hh_mesh_create. Shapes keep what they need after Dispose.</summary>
    public sealed unsafe class HhMesh : IDisposable {
        public IntPtr Handle { get; private set; }

        /// <summary>positions: x, y, z of each vertex, metres. indices: three for each triangle, counter-clockwise from outside.</summary>
        public HhMesh(float[] positions, uint[] indices, bool fitsHands = true) {
            Library.RequireVersion();
            if (positions.Length % 3 != 0) {
                throw new ArgumentException("positions: " + positions.Length + " numbers are not a multiple of 3");
            }
            MeshDef def = MeshDef.Default();
            fixed (float* positionsAt = positions) fixed (uint* indicesAt = indices) {
                def.positions = positionsAt;
                def.vertex_count = (UIntPtr)(uint)(positions.Length / 3);
                def.indices = indicesAt;
                def.index_count = (UIntPtr)(uint)indices.Length;
                def.fits_hands = fitsHands;
                IntPtr made;
                Library.Check(Native.hh_mesh_create(&def, &made));
                Handle = made;
            }
        }
        public void Dispose() {
            Library.RefuseInCallback("a mesh");
            Destroy();
            GC.SuppressFinalize(this);
        }
        ~HhMesh() { Destroy(); }
        private void Destroy() {
            if (Handle != IntPtr.Zero) {
                Native.hh_mesh_destroy(Handle);
                Handle = IntPtr.Zero;
            }
        }
    }

    /// <summary>The surfaces of a host with physics of its own: hh_surface_query. Each function returns false if it finds nothing.
    /// They are called inside of steps, by the thread that steps. An exception counts as nothing found, and is thrown when the step has ended.</summary>
    public interface ISurfaces {
        bool CastRay(Vec3 from, Vec3 to, SkippedBodies skip, out SurfaceHit hit);
        bool CastSphere(double radius_m, Vec3 from, Vec3 to, SkippedBodies skip, out SurfaceHit hit);
        bool ClosestPoint(Vec3 point, double max_distance_m, SkippedBodies skip, out SurfaceHit hit);
        bool ClosestPointOn(Body body, Vec3 point, out SurfaceHit hit);
    }

    /// <summary>Bodies that count as not there. Valid during the query.</summary>
    public unsafe struct SkippedBodies {
        private readonly Body* first;
        private readonly long count;
        internal SkippedBodies(Body* first, UIntPtr count) {
            this.first = first;
            this.count = (long)count;
        }
        public bool Contains(Body body) {
            for (long i = 0; i < count; ++i) {
                if (first[i] == body) {
                    return true;
                }
            }
            return false;
        }
    }

    /// <summary>A simulation with its shapes, bodies and players. Dispose it. Calls on one world must not overlap.</summary>
    public sealed unsafe partial class World : IDisposable {
        public IntPtr Handle { get; private set; }
        /// <summary>What hands ask; null: the world's shapes.</summary>
        public ISurfaces Surfaces { get; private set; }
        private GCHandle surfacesHandle;  // weak: surfaces that know their world do not keep it
        internal Match Match;             // null: the world is in none

        public World() : this(WorldDef.Default()) { }
        public World(WorldDef def) {
            Library.RequireVersion();
            IntPtr made;
            Library.Check(Native.hh_world_create(&def, &made));
            Handle = made;
        }
        /// <summary>Ends the world's match, if any, and destroys the world. Not inside a callback: Result.ErrorState.</summary>
        public void Dispose() {
            Library.RefuseInCallback("a world");
            Destroy();
            GC.SuppressFinalize(this);
        }
        ~World() { Destroy(); }
        private void Destroy() {
            if (Match != null) {
                Match.Destroy();
            }
            if (Handle != IntPtr.Zero) {
                Native.hh_world_destroy(Handle);
                Handle = IntPtr.Zero;
            }
            if (surfacesHandle.IsAllocated) {
                surfacesHandle.Free();
            }
        }

        /// <summary>Steps a world with one player.</summary>
        public void Step(double dt_s, Player player, TrackingSample[] samples, Commands commands = default(Commands)) {
            fixed (TrackingSample* samplesAt = samples) {
                PlayerInput input = InputOf(player, samplesAt, samples == null ? 0 : samples.Length, commands);
                Library.Check(Native.hh_world_step(Handle, dt_s, &input, (UIntPtr)1));
            }
            GC.KeepAlive(this);
        }
        /// <summary>First half of a step around the host's solver, with one player: hh_world_begin_step.</summary>
        public void BeginStep(double dt_s, Player player, TrackingSample[] samples, Commands commands = default(Commands)) {
            fixed (TrackingSample* samplesAt = samples) {
                PlayerInput input = InputOf(player, samplesAt, samples == null ? 0 : samples.Length, commands);
                Library.Check(Native.hh_world_begin_step(Handle, dt_s, &input, (UIntPtr)1));
            }
            GC.KeepAlive(this);
        }
        /// <summary>Input of one player. The samples must stay where they are until the step is done: pinned, or native.</summary>
        public static PlayerInput InputOf(Player player, TrackingSample* samples, int count, Commands commands) {
            PlayerInput input = PlayerInput.Default();
            input.player = player;
            input.samples = samples;
            input.sample_count = (UIntPtr)(uint)count;
            input.commands = commands;
            return input;
        }
        /// <summary>Samples are wrists with OpenXR's axes, not controllers.</summary>
        public void UseWrists(Player player) {
            PlayerSetHandInController(player, Side.Left, HhPose.Identity);
            PlayerSetHandInController(player, Side.Right, HhPose.Identity);
        }
        public PlayerPose PlayerPose(Player player) => PlayerPoses(new[] { player })[0];

        /// <summary>Hands ask `asked` from now on; null: the world's shapes.</summary>
        public void SetSurfaces(ISurfaces asked) {
            GCHandle made = default(GCHandle);
            SurfaceQuery query = default(SurfaceQuery);
            if (asked != null) {
                made = GCHandle.Alloc(asked, GCHandleType.Weak);
                query = SurfaceQuery.Default();
                query.context = GCHandle.ToIntPtr(made);
                query.cast_ray = Marshal.GetFunctionPointerForDelegate(castRay);
                query.cast_sphere = Marshal.GetFunctionPointerForDelegate(castSphere);
                query.closest_point = Marshal.GetFunctionPointerForDelegate(closestPoint);
                query.closest_point_on = Marshal.GetFunctionPointerForDelegate(closestPointOn);
            }
            Result result = Native.hh_world_set_surface_query(Handle, asked == null ? null : &query);
            GCHandle unused = result == Result.Ok ? surfacesHandle : made;
            if (result == Result.Ok) {
                Surfaces = asked;
                surfacesHandle = made;
            }
            if (unused.IsAllocated) {
                unused.Free();
            }
            GC.KeepAlive(this);
            Library.Check(result);
        }

        // Static functions, which IL2CPP can pass to native code; kept here so that the collector leaves them.
        private static readonly SurfaceQueryCastRay castRay = CastRay;
        private static readonly SurfaceQueryCastSphere castSphere = CastSphere;
        private static readonly SurfaceQueryClosestPoint closestPoint = ClosestPoint;
        private static readonly SurfaceQueryClosestPointOn closestPointOn = ClosestPointOn;

        private static ISurfaces Of(IntPtr context) => (ISurfaces)GCHandle.FromIntPtr(context).Target;
        private static byte Answer(bool isFound, SurfaceHit found, SurfaceHit* hit) {
            if (isFound) {
                *hit = found;
            }
            return (byte)(isFound ? 1 : 0);
        }

        [MonoPInvokeCallback(typeof(SurfaceQueryCastRay))]
        private static byte CastRay(IntPtr context, Vec3 from, Vec3 to, Body* skip, UIntPtr count, SurfaceHit* hit) {
            Library.BeginCallback();
            try {
                SurfaceHit found;
                return Answer(Of(context).CastRay(from, to, new SkippedBodies(skip, count), out found), found, hit);
            } catch (Exception error) {
                return Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
        [MonoPInvokeCallback(typeof(SurfaceQueryCastSphere))]
        private static byte CastSphere(IntPtr context, double radius, Vec3 from, Vec3 to, Body* skip, UIntPtr count, SurfaceHit* hit) {
            Library.BeginCallback();
            try {
                SurfaceHit found;
                return Answer(Of(context).CastSphere(radius, from, to, new SkippedBodies(skip, count), out found), found, hit);
            } catch (Exception error) {
                return Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
        [MonoPInvokeCallback(typeof(SurfaceQueryClosestPoint))]
        private static byte ClosestPoint(IntPtr context, Vec3 point, double max, Body* skip, UIntPtr count, SurfaceHit* hit) {
            Library.BeginCallback();
            try {
                SurfaceHit found;
                return Answer(Of(context).ClosestPoint(point, max, new SkippedBodies(skip, count), out found), found, hit);
            } catch (Exception error) {
                return Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
        [MonoPInvokeCallback(typeof(SurfaceQueryClosestPointOn))]
        private static byte ClosestPointOn(IntPtr context, Body body, Vec3 point, SurfaceHit* hit) {
            Library.BeginCallback();
            try {
                SurfaceHit found;
                return Answer(Of(context).ClosestPointOn(body, point, out found), found, hit);
            } catch (Exception error) {
                return Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
    }

#if !UNITY_5_3_OR_NEWER
    // Unity's compilers look for this name.
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute {
        public MonoPInvokeCallbackAttribute(Type type) { }
    }
#endif
}
