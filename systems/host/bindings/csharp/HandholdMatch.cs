// Matches in C#: what is not generated. Ownership, the game's functions, and inputs. Methods of a Match are the functions hh_match_x as X.
using System;
using System.Runtime.InteropServices;
#if UNITY_5_3_OR_NEWER
using AOT;
#endif

namespace Handhold {
    /// <summary>State of your own in a match, such as scores, which goes back and forth with the world's: hh_match_game. The functions are called
    /// inside of calls of the match, by the thread that makes them. The first exception is thrown when that call has ended. The call still takes
    /// effect, as if the function had returned (Hash: 0).</summary>
    public interface IMatchGame {
        /// <summary>After each step of the world to `tick`, also when it is stepped again. What it does may depend on the world, your state, `tick` and
        /// `buttons` only: those of each slot. The array is valid during the call.</summary>
        void Step(ulong tick, uint[] buttons);
        /// <summary>Keeps a copy of your state in a place of yours, 0 to Constants.MatchPlaces - 1, over the one before.</summary>
        void Save(int place);
        /// <summary>Sets your state to the copy in that place.</summary>
        void Restore(int place);
        /// <summary>Hash of your state: machines compare it together with the world's.</summary>
        ulong Hash();
    }

    /// <summary>A world's part in a match: a server, a client, a spectator or a sync test. Your transport carries its packets. Dispose it; its
    /// world's Dispose ends it too.</summary>
    public sealed unsafe partial class Match : IDisposable {
        public IntPtr Handle { get; private set; }
        public World World { get; private set; }
        public IMatchGame Game { get; private set; }
        private GCHandle self;  // weak: what the functions get as context
        private readonly uint[] buttons;

        /// <summary>Begins a match at the world's present tick. `players`: by slot, the same on every machine. `game` null: no state of your own.</summary>
        public Match(World world, Player[] players, MatchDef def, IMatchGame game = null) {
            Library.RequireVersion();
            World = world;
            Game = game;
            buttons = new uint[players == null ? 0 : players.Length];
            self = GCHandle.Alloc(this, GCHandleType.Weak);
            MatchGame functions = MatchGame.Default();
            functions.context = GCHandle.ToIntPtr(self);
            functions.step = Marshal.GetFunctionPointerForDelegate(step);
            functions.save = Marshal.GetFunctionPointerForDelegate(save);
            functions.restore = Marshal.GetFunctionPointerForDelegate(restore);
            functions.hash = Marshal.GetFunctionPointerForDelegate(hash);
            IntPtr made = IntPtr.Zero;
            Result result;
            fixed (Player* playersAt = players) {
                def.players = playersAt;
                def.player_count = Library.Count(players);
                result = Native.hh_match_create(world == null ? IntPtr.Zero : world.Handle, &def, game == null ? null : &functions, &made);
            }
            Handle = made;
            if (made != IntPtr.Zero) {
                world.Match = this;
            }
            try {
                Library.Check(result);
            } catch {
                Destroy();
                throw;
            }
        }
        /// <summary>Ends the match; the world stays as it is. Not inside a callback: Result.ErrorState.</summary>
        public void Dispose() {
            Library.RefuseInCallback("a match");
            Destroy();
            GC.SuppressFinalize(this);
        }
        ~Match() { Destroy(); }
        internal void Destroy() {
            if (Handle != IntPtr.Zero) {
                Native.hh_match_destroy(Handle);
                Handle = IntPtr.Zero;
                World.Match = null;
            }
            if (self.IsAllocated) {
                self.Free();
            }
        }

        /// <summary>hh_match_advance with the own player's devices. `pressed`: your bits, for IMatchGame.Step. `isHidden`: the tick is not shown.</summary>
        public bool Advance(TrackingSample[] samples, uint pressed = 0, Commands commands = default(Commands), bool isHidden = false) {
            fixed (TrackingSample* samplesAt = samples) {
                MatchInput input = InputOf(samplesAt, samples == null ? 0 : samples.Length, pressed, commands);
                input.is_hidden = isHidden;
                return Advance(input);
            }
        }
        /// <summary>hh_match_sync_test with one sample for each slot. `pressed`: your bits of each slot; null: none.</summary>
        public MatchDifference SyncTest(TrackingSample[] samples, uint[] pressed = null) {
            if (pressed != null) {
                Library.RequireLength(pressed, samples == null ? 0 : samples.Length, "pressed");
            }
            MatchInput[] inputs = new MatchInput[samples == null ? 0 : samples.Length];
            fixed (TrackingSample* samplesAt = samples) {
                for (int slot = 0; slot < inputs.Length; ++slot) {
                    inputs[slot] = InputOf(samplesAt + slot, 1, pressed == null ? 0 : pressed[slot], default(Commands));
                }
                return SyncTest(inputs);
            }
        }
        /// <summary>Input of one player. The samples must stay where they are until the call is done: pinned, or native.</summary>
        public static MatchInput InputOf(TrackingSample* samples, int count, uint pressed, Commands commands) {
            MatchInput input = MatchInput.Default();
            input.samples = samples;
            input.sample_count = (UIntPtr)(uint)count;
            input.buttons = pressed;
            input.commands = commands;
            return input;
        }

        // Static functions, which IL2CPP can pass to native code; kept here so that the collector leaves them.
        private static readonly MatchGameStep step = Step;
        private static readonly MatchGameSave save = Save;
        private static readonly MatchGameRestore restore = Restore;
        private static readonly MatchGameHash hash = HashOfGame;

        private static Match Of(IntPtr context) => (Match)GCHandle.FromIntPtr(context).Target;

        [MonoPInvokeCallback(typeof(MatchGameStep))]
        private static void Step(IntPtr context, ulong tick, uint* pressed, UIntPtr count) {
            Library.BeginCallback();
            try {
                Match match = Of(context);
                for (int slot = 0; slot < match.buttons.Length; ++slot) {
                    match.buttons[slot] = pressed[slot];
                }
                match.Game.Step(tick, match.buttons);
            } catch (Exception error) {
                Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
        [MonoPInvokeCallback(typeof(MatchGameSave))]
        private static void Save(IntPtr context, uint place) {
            Library.BeginCallback();
            try {
                Of(context).Game.Save((int)place);
            } catch (Exception error) {
                Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
        [MonoPInvokeCallback(typeof(MatchGameRestore))]
        private static void Restore(IntPtr context, uint place) {
            Library.BeginCallback();
            try {
                Of(context).Game.Restore((int)place);
            } catch (Exception error) {
                Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
        [MonoPInvokeCallback(typeof(MatchGameHash))]
        private static ulong HashOfGame(IntPtr context) {
            Library.BeginCallback();
            try {
                return Of(context).Game.Hash();
            } catch (Exception error) {
                return Library.Failed(error);
            } finally {
                Library.EndCallback();
            }
        }
    }
}
