// The C interface's enums, structs and functions. Made by systems/host/bindings/generate.py; do not edit.
using System;
using System.Runtime.InteropServices;

#pragma warning disable 660, 661, 1591

namespace Handhold {
    /// <summary>Numbers of the C headers.</summary>
    public static class Constants {
        public const int HandholdVersionMajor = 0;
        public const int HandholdVersionMinor = 2;
        public const int HandholdVersionPatch = 0;
        public const string HandholdVersionText = "0.2.0";
        public const int HandJointCount = 26;
        public const int IsByName = 0;
        public const int IsBody = 100;
        public const int IsLeftHand = 200;
        public const int IsRightHand = 300;
        public const int MatchPlayers = 16;
        public const int MatchPacketBytes = 1200;
        public const int MatchInputsBytes = 8192;
        public const uint MatchNoSlot = 4294967295;
        public const int MatchPlaces = 64;
        public const int MatchRefusals = 16;
    }

    public enum Result {
        Ok = 0,
        /// <summary>a pointer that is needed is null</summary>
        ErrorNull = 1,
        /// <summary>a size of a struct is not of a version that the library knows</summary>
        ErrorVersion = 2,
        /// <summary>an id is null, stale or of another world</summary>
        ErrorHandle = 3,
        /// <summary>a number is NaN or out of range, or a combination makes no sense</summary>
        ErrorValue = 4,
        /// <summary>a name is taken, or nothing has it</summary>
        ErrorName = 5,
        /// <summary>not possible now, for instance a shape in use</summary>
        ErrorState = 6,
        /// <summary>the buffer is too small; the count says how much is needed</summary>
        ErrorCapacity = 7,
        /// <summary>bytes that cannot be read: a snapshot, a glTF file, JSON</summary>
        ErrorData = 8,
        /// <summary>no memory left</summary>
        ErrorMemory = 9,
        /// <summary>a defect of the library; hh_host_hooks.assert_failed was called</summary>
        ErrorInternal = 10,
    }

    public enum Side {
        Left = 0,
        Right = 1,
    }

    public enum LogLevel {
        Note = 0,
        Error = 1,
    }

    public enum Engine {
        /// <summary>left-handed, +X right, +Y up, +Z ahead, metres</summary>
        Unity = 0,
        /// <summary>left-handed, +X ahead, +Y right, +Z up, centimetres</summary>
        Unreal = 1,
        /// <summary>as Handhold: right-handed, +X right, +Y up, -Z ahead, metres</summary>
        Godot = 2,
    }

    /// <summary>What receives the impulses of constraints, index of hh_momentum's arrays.</summary>
    public enum MomentumReceiver {
        /// <summary>dynamic bodies</summary>
        Bodies = 0,
        Players = 1,
        /// <summary>impulses of hands on bodies that did not push the player back</summary>
        Discarded = 2,
        /// <summary>static and kinematic bodies</summary>
        Statics = 3,
        Receivers = 4,
    }

    public enum BodyKind {
        /// <summary>never moves, except by hh_body_teleport</summary>
        Static = 0,
        /// <summary>moved by hh_body_move_kinematic; pushes others and carries hands</summary>
        Kinematic = 1,
        /// <summary>moved by its velocity, contacts, joints and hands</summary>
        Dynamic = 2,
    }

    /// <summary>Each kind has a coordinate, on which limits, friction, detents and latches act.</summary>
    public enum JointKind {
        /// <summary>points coincide; coordinate: angle between the axes, rad; limits: a cone</summary>
        Ball = 0,
        /// <summary>turns about the axis; coordinate: angle, rad</summary>
        Hinge = 1,
        /// <summary>moves along the axis; coordinate: displacement, m</summary>
        Slider = 2,
        /// <summary>no coordinate</summary>
        Fixed = 3,
        /// <summary>coordinate: distance of two points, m; lower 0: a rope; equal limits: a rod</summary>
        Distance = 4,
    }

    public enum MotorKind {
        None = 0,
        /// <summary>towards a speed of the coordinate</summary>
        Speed = 1,
        /// <summary>towards a coordinate</summary>
        Position = 2,
    }

    public enum GripKind {
        None = 0,
        /// <summary>something static, kinematic or heavy: the player moves</summary>
        Surface = 1,
        /// <summary>a dynamic body: it moves with the hand</summary>
        Held = 2,
        /// <summary>in one of the body's authored grips</summary>
        Authored = 3,
        /// <summary>another player: head, arm, trunk or leg</summary>
        Player = 4,
    }

    public enum EventKind {
        /// <summary>The palm of an empty, tracked hand came within 2 cm times the player's scale of a body or of another player's head.</summary>
        Touched = 0,
        /// <summary>a hand grips</summary>
        Grabbed = 1,
        /// <summary>the player opened the hand, or `reason` says who did</summary>
        Released = 2,
        /// <summary>a hand closed and grips nothing: `reason`</summary>
        Refused = 3,
        /// <summary>a hand lost its grip: `reason`</summary>
        Slipped = 4,
        /// <summary>The player's head, or what a hand holds, hits a body or another player's head.</summary>
        ContactBegan = 5,
        ContactEnded = 6,
        /// <summary>of `joint`</summary>
        LatchClosed = 7,
        LatchOpened = 8,
        /// <summary>a joint came to its lower or upper limit</summary>
        LimitReached = 9,
        /// <summary>hh_player_pose.origin was changed so that a recentring moves nothing. HH_REASON_BY_HOST: by hh_player_recenter; HH_REASON_NONE: the samples jumped. `position`: the head.</summary>
        Recentred = 10,
    }

    public enum Reason {
        None = 0,
        /// <summary>the player opened the hand</summary>
        Opened = 1,
        /// <summary>nothing in reach, or only behind a wall</summary>
        NoSurface = 2,
        /// <summary>a grab rule or layers refuse the hand</summary>
        NotAllowed = 3,
        /// <summary>the other hand is not there, or left</summary>
        NeedsTwoHands = 4,
        /// <summary>farther from its anchor than hand.max_stretch_m</summary>
        Stretched = 5,
        /// <summary>it opened unseen, or came back too far away</summary>
        TrackingLost = 6,
        /// <summary>the body was removed</summary>
        BodyGone = 7,
        /// <summary>hh_hand_release, hh_hand_grip, hh_hand_hold, hh_body_set_shape or a teleport</summary>
        ByHost = 8,
        /// <summary>the other of two hands on a body let go</summary>
        OtherHand = 9,
    }

    public enum HhSpace {
        World = 0,
        /// <summary>in the parent joint's frame; roots: in the world</summary>
        Parent = 1,
    }

    /// <summary>Joints as XR_EXT_hand_tracking has them, in its order and with its axes. The parent of palm and metacarpals is the wrist.</summary>
    public enum HandJointName {
        HandPalm = 0,
        HandWrist = 1,
        ThumbMetacarpal = 2,
        ThumbProximal = 3,
        ThumbDistal = 4,
        ThumbTip = 5,
        IndexMetacarpal = 6,
        IndexProximal = 7,
        IndexIntermediate = 8,
        IndexDistal = 9,
        IndexTip = 10,
        MiddleMetacarpal = 11,
        MiddleProximal = 12,
        MiddleIntermediate = 13,
        MiddleDistal = 14,
        MiddleTip = 15,
        RingMetacarpal = 16,
        RingProximal = 17,
        RingIntermediate = 18,
        RingDistal = 19,
        RingTip = 20,
        LittleMetacarpal = 21,
        LittleProximal = 22,
        LittleIntermediate = 23,
        LittleDistal = 24,
        LittleTip = 25,
    }

    /// <summary>Joints of a humanoid, with VRM's names. Trunk, head and legs: +Y up along the bone, -Z to the front. Arms: -Z along the bone, +Y on the elbow's side. Hands: the wrist's axes.</summary>
    public enum BodyJoint {
        Hips = 0,
        Spine = 1,
        Chest = 2,
        UpperChest = 3,
        Neck = 4,
        Head = 5,
        LeftShoulder = 6,
        LeftUpperArm = 7,
        LeftLowerArm = 8,
        LeftHand = 9,
        RightShoulder = 10,
        RightUpperArm = 11,
        RightLowerArm = 12,
        RightHand = 13,
        LeftUpperLeg = 14,
        LeftLowerLeg = 15,
        LeftFoot = 16,
        RightUpperLeg = 17,
        RightLowerLeg = 18,
        RightFoot = 19,
        BodyJointCount = 20,
    }

    /// <summary>What a hand asks of the host's solver. The player is a body of the host's: a point mass at the play space's origin that cannot turn: at hh_player_pose.origin until a recentring, which does not move it. At the end of the step, with origin and body solved: POINT origin + target.position = body * anchor.position WELD the same, and the body's rotation is body_rotation DIRECTION the body's rotation is body_rotation: the second of two hands on one body</summary>
    public enum HandRows {
        Point = 0,
        Weld = 1,
        Direction = 2,
    }

    public enum MatchRole {
        Client = 0,
        Server = 1,
        /// <summary>No network: every tick is stepped again from `sync_ticks` before, and must give the same hashes. Finds state that your game forgets to restore.</summary>
        SyncTest = 2,
        /// <summary>Nobody's machine: steps confirmed ticks only, from hh_match_confirmed_inputs. For those who watch, and for recordings of matches. Has no slot and sends no packets.</summary>
        Spectator = 3,
    }

    public enum MatchEventState {
        /// <summary>It happened in a tick that may change. Each such event is confirmed or retracted later.</summary>
        Predicted = 0,
        /// <summary>its tick is final. Each event of a confirmed tick comes so once</summary>
        Confirmed = 1,
        /// <summary>a predicted event that did not happen</summary>
        Retracted = 2,
    }

    /// <summary>Why a packet was refused: index of hh_match_stats.refused.</summary>
    public enum MatchRefusal {
        /// <summary>shorter than any packet, or longer</summary>
        Size = 1,
        /// <summary>damaged</summary>
        Checksum = 2,
        /// <summary>of another version of the format, or another kind</summary>
        Version = 3,
        /// <summary>another slot's, or of one that is not connected</summary>
        Sender = 4,
        /// <summary>fields out of range</summary>
        Malformed = 5,
        /// <summary>inputs before it have not arrived. Usual with losses</summary>
        Gap = 6,
        /// <summary>too old or too far ahead. Usual around joins</summary>
        Window = 7,
        /// <summary>a state that hh_match_join could not restore</summary>
        State = 8,
    }

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void HhTask(IntPtr task_context, UIntPtr index);

    /// <summary>Called by any thread that calls the library. `message` is one line, valid during the call.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void HostHooksLog(IntPtr context, LogLevel level, byte* message);

    /// <summary>A defect of the library was found; the call then returns HH_ERROR_INTERNAL.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void HostHooksAssertFailed(IntPtr context, byte* message);

    /// <summary>Calls task(task_context, i) once for every i in [0, count), on any threads, and returns when all are done. Indices should start in ascending order.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void HostHooksParallelFor(IntPtr context, UIntPtr count, IntPtr task, IntPtr task_context);

    /// <summary>First surface that the segment hits, from outside or inside. distance_m is not read.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate byte SurfaceQueryCastRay(IntPtr context, Vec3 from, Vec3 to, Body* skip, UIntPtr skip_count, SurfaceHit* hit);

    /// <summary>First impact of a sphere moving along a segment; distance_m: how far its centre has moved. For the distance grab (pull.reach_m above 0), and to keep trunk and legs out of surfaces: about one query per player and frame. Null: neither.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate byte SurfaceQueryCastSphere(IntPtr context, double radius_m, Vec3 from, Vec3 to, Body* skip, UIntPtr skip_count, SurfaceHit* hit);

    /// <summary>Nearest surface point within max_distance_m; distance_m: 0 inside a solid.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate byte SurfaceQueryClosestPoint(IntPtr context, Vec3 point, double max_distance_m, Body* skip, UIntPtr skip_count, SurfaceHit* hit);

    /// <summary>Nearest surface point of one body, at any distance; distance_m: 0 inside a solid.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate byte SurfaceQueryClosestPointOn(IntPtr context, Body body, Vec3 point, SurfaceHit* hit);

    /// <summary>Called after each step of the world to `tick`, also when it is stepped again. May read the world and its events, and may change its bodies, joints, grips and players; it must not add or remove any. What it does may depend on the world, your state, `tick` and `buttons` only: hh_match_input.buttons of each slot, of which there are `button_count`. What hosts draw, such as hh_player_pose, differs between machines.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void MatchGameStep(IntPtr context, ulong tick, uint* buttons, UIntPtr button_count);

    /// <summary>Keeps a copy of your state in a place of yours, [0, HH_MATCH_PLACES), over the one before. A server saves nothing.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void MatchGameSave(IntPtr context, uint place);

    /// <summary>Sets your state to the copy in that place.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate void MatchGameRestore(IntPtr context, uint place);

    /// <summary>Hash of your state: machines compare it together with the world's.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public unsafe delegate ulong MatchGameHash(IntPtr context);

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Vec3 {
        public double x;
        public double y;
        public double z;

        public Vec3(double x, double y, double z) {
            this.x = x;
            this.y = y;
            this.z = z;
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Quat {
        public double x;
        public double y;
        public double z;
        public double w;

        public Quat(double x, double y, double z, double w) {
            this.x = x;
            this.y = y;
            this.z = z;
            this.w = w;
        }
    }

    /// <summary>A rigid transform: rotates, then translates. Inputs need a unit rotation within 0.001.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HhPose {
        /// <summary>metres</summary>
        public Vec3 position;
        public Quat rotation;
    }

    /// <summary>How far each finger is bent: thumb, index, middle, ring, little. 0: straight; 1: as in a fist; above 1: as 1; below 0 or NaN: unknown.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct FingerCurls {
        public DoubleArray5 fingers;
    }

    /// <summary>Ids: plain values. All zero is null. An id whose object was removed finds nothing, even if its index is used again. Ids of two worlds must not be mixed; that is not always detected.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Shape {
        public uint index;
        public uint generation;

        public Shape(uint index, uint generation) {
            this.index = index;
            this.generation = generation;
        }
        /// <summary>True for the null id.</summary>
        public bool IsNull => index == 0 && generation == 0;
        public static bool operator ==(Shape a, Shape b) => a.index == b.index && a.generation == b.generation;
        public static bool operator !=(Shape a, Shape b) => !(a == b);
        public override bool Equals(object other) => other is Shape && this == (Shape)other;
        public override int GetHashCode() => (int)(index * 2654435761u ^ generation);
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Body {
        public uint index;
        public uint generation;

        public Body(uint index, uint generation) {
            this.index = index;
            this.generation = generation;
        }
        /// <summary>True for the null id.</summary>
        public bool IsNull => index == 0 && generation == 0;
        public static bool operator ==(Body a, Body b) => a.index == b.index && a.generation == b.generation;
        public static bool operator !=(Body a, Body b) => !(a == b);
        public override bool Equals(object other) => other is Body && this == (Body)other;
        public override int GetHashCode() => (int)(index * 2654435761u ^ generation);
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HhJoint {
        public uint index;
        public uint generation;

        public HhJoint(uint index, uint generation) {
            this.index = index;
            this.generation = generation;
        }
        /// <summary>True for the null id.</summary>
        public bool IsNull => index == 0 && generation == 0;
        public static bool operator ==(HhJoint a, HhJoint b) => a.index == b.index && a.generation == b.generation;
        public static bool operator !=(HhJoint a, HhJoint b) => !(a == b);
        public override bool Equals(object other) => other is HhJoint && this == (HhJoint)other;
        public override int GetHashCode() => (int)(index * 2654435761u ^ generation);
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Player {
        public uint index;
        public uint generation;

        public Player(uint index, uint generation) {
            this.index = index;
            this.generation = generation;
        }
        /// <summary>True for the null id.</summary>
        public bool IsNull => index == 0 && generation == 0;
        public static bool operator ==(Player a, Player b) => a.index == b.index && a.generation == b.generation;
        public static bool operator !=(Player a, Player b) => !(a == b);
        public override bool Equals(object other) => other is Player && this == (Player)other;
        public override int GetHashCode() => (int)(index * 2654435761u ^ generation);
    }

    /// <summary>Functions of the host that the library uses. Null functions are not called; without parallel_for the library has its own threads. Memory comes from the global operator new, which a program may replace as usual; the shared library and the standard library inside it then use the replacement too, once per process. Apart from that a world's blocks are taken and given back by the threads that call it, and by those of parallel_for: a replacement with an arena a thread gives each world its own. A host that uses Bullet needs its double-precision build, and sets btAlignedAllocSetCustom before the first world.</summary>
    /// <remarks>For Native: keep the delegates of all functions alive while the library may call them, and make them static methods with
    /// MonoPInvokeCallback for IL2CPP. World.SetSurfaces, Match and Library.SetLog do both.</remarks>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HostHooks {
        public uint struct_size;
        /// <summary>passed to each of the functions</summary>
        public IntPtr context;
        /// <summary>Called by any thread that calls the library. `message` is one line, valid during the call.</summary>
        public IntPtr log;
        /// <summary>A defect of the library was found; the call then returns HH_ERROR_INTERNAL.</summary>
        public IntPtr assert_failed;
        /// <summary>Calls task(task_context, i) once for every i in [0, count), on any threads, and returns when all are done. Indices should start in ascending order.</summary>
        public IntPtr parallel_for;
        /// <summary>Without parallel_for: threads of the library's own pool, the caller's included. [1, 256]; default 1. Results do not depend on it.</summary>
        public uint thread_count;

        /// <summary>The library's defaults.</summary>
        public static HostHooks Default() {
            HostHooks filled;
            Library.Check(Native.hh_default_host_hooks_sized(&filled, (UIntPtr)sizeof(HostHooks)));
            return filled;
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct WorldDef {
        public uint struct_size;
        /// <summary>Fingers and palms close on what they grip. Default true. Without it no shape needs a grip mesh, hands are shown as tracked, and meshes are added faster: for servers.</summary>
        public Flag fits_hands;
        /// <summary>HH_EVENT_TOUCHED is reported: one query a step for each empty hand. Default true.</summary>
        public Flag reports_touches;
        /// <summary>of dynamic bodies; default 0. Each axis within 1e4</summary>
        public Vec3 gravity_mps2;
        /// <summary>of the scene: what counts as rest. Each axis within 1e6</summary>
        public Vec3 reference_velocity_mps;

        /// <summary>The library's defaults.</summary>
        public static WorldDef Default() {
            WorldDef filled;
            Library.Check(Native.hh_default_world_def_sized(&filled, (UIntPtr)sizeof(WorldDef)));
            return filled;
        }
    }

    /// <summary>One reading of the headset and both controllers. A pose at exactly (0, 0, 0) counts as not tracked, since runtimes report devices that sleep so.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct TrackingSample {
        public uint struct_size;
        /// <summary>On the world's clock: hh_world_time plus the step for a sample at the step's end. A sample that is not later than the one before is ignored and counted as sample_out_of_order. More than 0.5 s after the step's end, it is dropped and counted as sample_too_far_ahead, unless hh_player_input.repeats_samples; more than 0.5 s before the step's start, it is counted as sample_too_old. If all samples of a player in a step are so far off, the log is told, once per world, that they are on another clock. hh_world_step_pose_only takes any times.</summary>
        public double time_s;
        /// <summary>between the eyes, in play space: the frame that the tracking is given in</summary>
        public HhPose head;
        /// <summary>controllers, by hh_side; see hh_player_set_hand_in_controller</summary>
        public HhPoseArray2 hands;
        /// <summary>false: `head` is ignored</summary>
        public Flag head_tracked;
        /// <summary>false: the pose is ignored, `grab` counts</summary>
        public FlagArray2 hand_tracked;
        /// <summary>a button that closes the hand is down</summary>
        public FlagArray2 grab;
        /// <summary>how far it is pressed, [0, 1]: bends fingers until `grab` closes them</summary>
        public DoubleArray2 squeeze;
        /// <summary>How far the index finger's trigger is pressed, [0, 1]: bends the index finger of an empty hand, and the fingers of authored grips that follow the trigger.</summary>
        public DoubleArray2 trigger;
        /// <summary>True if the runtime only guesses the head's position: OpenXR's POSITION_VALID without POSITION_TRACKED, WebXR's emulatedPosition, a low confidence. Default false; true overrides head_tracked. The head follows the guess, but while a hand grips what the player can pull on, only its rotation does.</summary>
        public Flag head_inferred;
        /// <summary>The same for the hands; true overrides hand_tracked. An inferred hand does not begin to grip, and never moves a player who grips: it stays where it was last measured. Opening `grab` lets go, without a throw. The shown empty hand follows the guess. When the hand is measured again, its displacement since does not count as travel.</summary>
        public FlagArray2 hand_inferred;
        /// <summary>Bend of the fingers of an empty hand; known curls override squeeze and trigger. Default unknown. Measured by gloves, or made from joints by hh_finger_curls_of.</summary>
        public FingerCurlsArray2 curls;

        /// <summary>The library's defaults.</summary>
        public static TrackingSample Default() {
            TrackingSample filled;
            Library.Check(Native.hh_default_tracking_sample_sized(&filled, (UIntPtr)sizeof(TrackingSample)));
            return filled;
        }
    }

    /// <summary>What a player asks for in one step. All zero: nothing. Grows with hh_player_input, of which it is the last field. In the fields of later versions, too, 0 will ask for nothing.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Commands {
        /// <summary>[-1, 1], positive turns left</summary>
        public double smooth_turn;
        /// <summary>turns to the left begun in this step; negative: to the right</summary>
        public int snap_turns;
        /// <summary>[0, 1]</summary>
        public double brake;
        /// <summary>play space, each in [-1, 1]; needs locomotion.thruster_mps2 above 0</summary>
        public Vec3 thrust;
        /// <summary>held while the player holds a T-pose: measures the body</summary>
        public Flag calibrate;
    }

    /// <summary>One player's input of one step. Fill by hh_default_player_input.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct PlayerInput {
        public uint struct_size;
        public Player player;
        /// <summary>The samples since the last step, sorted by time. Give each once. Up to 64 may be later than this step's end, by at most 0.5 s, as predicted poses are: the poses at the end are then interpolated, and each sample is kept for the step of its time, even if that step has no input. A new sample replaces kept samples of the same time or later. None: the devices are silent, except for kept samples.</summary>
        public TrackingSample* samples;
        public UIntPtr sample_count;
        /// <summary>True: the host gives a sample that is later than the step's end again in the next step, so the world keeps none, and sample times are exact. False, the default: up to a microsecond after the step's end counts as the end. For hosts that have the whole stream: recordings, rollback.</summary>
        public Flag repeats_samples;
        public Commands commands;

        /// <summary>The library's defaults.</summary>
        public static PlayerInput Default() {
            PlayerInput filled;
            Library.Check(Native.hh_default_player_input_sized(&filled, (UIntPtr)sizeof(PlayerInput)));
            return filled;
        }
    }

    /// <summary>Sums of all impulses of a step, by hh_momentum_receiver. Each array's sum is 0.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Momentum {
        public Vec3Array4 linear_kgmps;
        /// <summary>about the world's origin</summary>
        public Vec3Array4 angular_kgm2ps;
    }

    /// <summary>Numbers of the last step.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct WorldStats {
        public uint struct_size;
        public ulong bodies;
        public ulong joints;
        public ulong players;
        /// <summary>now</summary>
        public ulong shapes;
        public ulong contacts;
        /// <summary>groups of bodies that constraints connect</summary>
        public ulong islands;
        /// <summary>of all solves</summary>
        public ulong newton_iterations;
        /// <summary>largest distance of a gripping hand from its anchor</summary>
        public double hand_error_m;
        /// <summary>worst contact overlap at the end</summary>
        public double overlap_m;
        /// <summary>largest position error of a joint</summary>
        public double joint_error_m;
        /// <summary>sum of all stages</summary>
        public double step_us;
        /// <summary>largest error of a joint's direction, or angle beyond a limit</summary>
        public double joint_error_rad;
        /// <summary>islands in which something pushed a player back</summary>
        public ulong islands_pushed;
        /// <summary>searches for contacts inside the solve</summary>
        public ulong contact_rounds;
        /// <summary>hands that closed</summary>
        public ulong hands_closed;
        /// <summary>grips that began</summary>
        public ulong hands_gripped;
        public Momentum momentum;
        /// <summary>The two of `overlap_m`; null: a player's head, or no overlap.</summary>
        public Body deepest_a;
        /// <summary>The two of `overlap_m`; null: a player's head, or no overlap.</summary>
        public Body deepest_b;

        /// <summary>The library's defaults.</summary>
        public static WorldStats Default() {
            WorldStats filled;
            Library.Check(Native.hh_default_world_stats_sized(&filled, (UIntPtr)sizeof(WorldStats)));
            return filled;
        }
    }

    /// <summary>A tunable number, or a vector of three. Texts live as long as the process.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct TuningInfo {
        public uint struct_size;
        /// <summary>"hand.reach_m"</summary>
        public byte* name;
        /// <summary>"m", ""</summary>
        public byte* unit;
        public byte* what;
        public double low;
        /// <summary>of each component</summary>
        public double high;
        /// <summary>1 or 3</summary>
        public UIntPtr count;
        /// <summary>true: each player has the number times hh_player_def.scale</summary>
        public Flag scales;

        /// <summary>The library's defaults.</summary>
        public static TuningInfo Default() {
            TuningInfo filled;
            Library.Check(Native.hh_default_tuning_info_sized(&filled, (UIntPtr)sizeof(TuningInfo)));
            return filled;
        }
    }

    /// <summary>A part of a compound: any shape but a mesh or a compound.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct CompoundPart {
        public Shape shape;
        /// <summary>in the compound's frame</summary>
        public HhPose pose;
        /// <summary>give it for all parts, or 0 for all: the mass is then spread by volume</summary>
        public double mass_kg;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MeshDef {
        public uint struct_size;
        /// <summary>x, y, z of each vertex, metres</summary>
        public float* positions;
        public UIntPtr vertex_count;
        /// <summary>bytes from one vertex to the next; 0: 12</summary>
        public UIntPtr vertex_stride;
        public uint* indices;
        /// <summary>a multiple of 3, at most 3 * 2^21</summary>
        public UIntPtr index_count;
        /// <summary>default true; false: hands on it are shown as tracked</summary>
        public Flag fits_hands;

        /// <summary>The library's defaults.</summary>
        public static MeshDef Default() {
            MeshDef filled;
            Library.Check(Native.hh_default_mesh_def_sized(&filled, (UIntPtr)sizeof(MeshDef)));
            return filled;
        }
    }

    /// <summary>A body's pose is that of its shape's own frame, as the host made it: the library finds centre of mass and principal axes by itself. Velocities are those of the centre of mass, in the world.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct BodyDef {
        public uint struct_size;
        /// <summary>unique in the world, identifies the body in hashes; null: by its id</summary>
        public byte* name;
        public BodyKind kind;
        /// <summary>null: touches nothing</summary>
        public Shape shape;
        public HhPose pose;
        /// <summary>each within 1e6</summary>
        public Vec3 velocity_mps;
        /// <summary>each within 1e4</summary>
        public Vec3 angular_velocity_radps;
        /// <summary>dynamic: [1e-12, 1e15], default 1</summary>
        public double mass_kg;
        /// <summary>About the principal axes; 0: computed from the shape. A dynamic body without a shape needs one: HH_ERROR_VALUE.</summary>
        public Vec3 inertia_kgm2;
        /// <summary>[0, 1]</summary>
        public double restitution;
        /// <summary>[0, 1e6], default 0.4</summary>
        public double friction;
        /// <summary>default 1; within 1000</summary>
        public double gravity_scale;
        public uint layers;
        /// <summary>two bodies touch if each one's layers meet the other's mask</summary>
        public uint mask;
        public Flag grab_left;
        /// <summary>which hands may grip it; default both</summary>
        public Flag grab_right;
        /// <summary>only both hands of one player at once</summary>
        public Flag grab_two_hands;
        /// <summary>of bodies in reach, hands take one of highest priority; default 0</summary>
        public int grab_priority;
        /// <summary>the host's; not part of the state</summary>
        public ulong user_data;

        /// <summary>The library's defaults.</summary>
        public static BodyDef Default() {
            BodyDef filled;
            Library.Check(Native.hh_default_body_def_sized(&filled, (UIntPtr)sizeof(BodyDef)));
            return filled;
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct JointDef {
        public uint struct_size;
        /// <summary>unique in the world; null: by its id</summary>
        public byte* name;
        public JointKind kind;
        /// <summary>null: the world</summary>
        public Body body_a;
        public Body body_b;
        /// <summary>in the world, with the bodies where they are now: x is the joint's axis</summary>
        public HhPose frame;
        /// <summary>HH_DISTANCE: the point on body_b, in the world; the point on body_a is frame's.</summary>
        public Vec3 point_b;
        /// <summary>the two bodies touch each other; default false</summary>
        public Flag collides;
        /// <summary>lower and upper apply; distance joints are always limited</summary>
        public Flag limited;
        public double lower;
        public double upper;
        /// <summary>N, or N m about a hinge or any axis of a ball; &gt;= 0</summary>
        public double friction;
        /// <summary>a rest position at each multiple; 0: none</summary>
        public double detent_spacing;
        /// <summary>force towards the nearest rest position, N or N m</summary>
        public double detent_strength;
        /// <summary>the latch locks the coordinate at this</summary>
        public double latch_at;
        /// <summary>the latch closes within this distance; 0: no latch</summary>
        public double latch_range;
        /// <summary>the latch opens above this force, N or N m; 0: never by force</summary>
        public double latch_strength;
        /// <summary>a joint that opens it; null: none</summary>
        public HhJoint latch_handle;
        /// <summary>open while |handle's coordinate| is at least this</summary>
        public double latch_handle_at;

        /// <summary>The library's defaults.</summary>
        public static JointDef Default() {
            JointDef filled;
            Library.Check(Native.hh_default_joint_def_sized(&filled, (UIntPtr)sizeof(JointDef)));
            return filled;
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MotorDef {
        public uint struct_size;
        /// <summary>default HH_MOTOR_NONE</summary>
        public MotorKind kind;
        /// <summary>HH_MOTOR_SPEED: rad/s or m/s, within 1e9</summary>
        public double speed;
        /// <summary>HH_MOTOR_POSITION: rad or m, within 1e9; a hinge counts full turns</summary>
        public double position;
        /// <summary>HH_MOTOR_POSITION: the joint moves so fast that it would be there after this; a step at least, 1e9 at most, s; default 0.1</summary>
        public double time_s;
        /// <summary>largest force, N or N m, [0, 1e15]; default 0</summary>
        public double strength;

        /// <summary>The library's defaults.</summary>
        public static MotorDef Default() {
            MotorDef filled;
            Library.Check(Native.hh_default_motor_def_sized(&filled, (UIntPtr)sizeof(MotorDef)));
            return filled;
        }
    }

    /// <summary>Two surfaces that touched in the last step. Whichever of body and player is not null it is: a player's head, or a body.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Contact {
        public Body body_a;
        public Body body_b;
        public Player player_a;
        public Player player_b;
        /// <summary>on the surface of a, in the world</summary>
        public Vec3 point;
        /// <summary>unit, from b to a</summary>
        public Vec3 normal;
        /// <summary>how deep they overlap; negative: apart</summary>
        public double depth_m;
        /// <summary>that the step applied, &gt;= 0</summary>
        public double impulse_ns;
    }

    /// <summary>Queries test the shapes of all bodies, whatever their layers, and the tracked heads of players, at their present poses. Bodies without a shape, and surfaces of hh_world_set_surface_query, are not found. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; the first query after a change of the world also compares every body with its place before.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Hit {
        /// <summary>null: a player's head, or nothing was found</summary>
        public Body body;
        /// <summary>whose head; null: a body, or nothing was found</summary>
        public Player player;
        /// <summary>on the surface, in the world</summary>
        public Vec3 point;
        /// <summary>unit, to the side that the query came from</summary>
        public Vec3 normal;
        /// <summary>see each query</summary>
        public double distance_m;
    }

    /// <summary>Sizes of a player's body, each in [0.05, 5] m times hh_player_def.scale.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Measures {
        /// <summary>standing</summary>
        public double eye_height_m;
        /// <summary>between the shoulder joints</summary>
        public double shoulder_width_m;
        public double upper_arm_m;
        /// <summary>to the wrist</summary>
        public double forearm_m;

        public Measures(double eye_height_m, double shoulder_width_m, double upper_arm_m, double forearm_m) {
            this.eye_height_m = eye_height_m;
            this.shoulder_width_m = shoulder_width_m;
            this.upper_arm_m = upper_arm_m;
            this.forearm_m = forearm_m;
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct PlayerDef {
        public uint struct_size;
        /// <summary>unique in the world; null: by its id</summary>
        public byte* name;
        /// <summary>the space of the samples in the world</summary>
        public HhPose origin;
        public Vec3 velocity_mps;
        /// <summary>default 80</summary>
        public double mass_kg;
        /// <summary>Before scale: each in [0.05, 5] m. Default: unknown, the size is estimated from head and hands while the player plays, within 20 s and by less than 1 mm a step. Other measures stay.</summary>
        public Measures measures;
        /// <summary>Size of the player, [0.01, 100], default 1; else HH_ERROR_VALUE. Body, head, hands, reach and every number with hh_tuning_info.scales are times this. Samples and all results stay in the world's metres: a host gives the tracked poses times the scale. Tested from 0.1 to 20. The first hand of another scale than 1 that grips a shape copies its surface, at about 0.2 microseconds a triangle.</summary>
        public double scale;
        /// <summary>the head is a sphere of head.radius_m times scale; default true</summary>
        public Flag head_collides;
        /// <summary>Layers of the head; it touches a body if each one's layers meet the other's mask.</summary>
        public uint layers;
        /// <summary>Layers of the head; it touches a body if each one's layers meet the other's mask.</summary>
        public uint mask;
        /// <summary>the hands grip bodies with one of these layers; default all</summary>
        public uint grab_layers;
        public ulong user_data;

        /// <summary>The library's defaults.</summary>
        public static PlayerDef Default() {
            PlayerDef filled;
            Library.Check(Native.hh_default_player_def_sized(&filled, (UIntPtr)sizeof(PlayerDef)));
            return filled;
        }
    }

    /// <summary>Grows: see base.h.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HandState {
        public GripKind grip;
        /// <summary>gripped; null: none</summary>
        public Body body;
        /// <summary>gripped player; null: none</summary>
        public Player other;
        /// <summary>the wrist in the world, as the devices say</summary>
        public HhPose tracked;
        /// <summary>The wrist to draw. While it grips it is fitted to the surface near the anchor: centimetres from it, so that palm and fingers touch. A lost or never tracked hand that grips nothing hangs beside the trunk; it goes there and comes back at a bounded speed.</summary>
        public HhPose shown;
        /// <summary>The wrist in the frame of what it grips (a body, or a part of a player), from when the hand closed. The hand takes a new anchor after tracking errors, when the other hand of a shared grip lets go, and when the body's kind or mass changes.</summary>
        public HhPose anchor;
        /// <summary>Distance of the tracked wrist from the anchor: 0 unless something blocks it.</summary>
        public double error_m;
        /// <summary>Impulse of the hand on what it grips in the last step, for haptics. 0 if the host's solver moved the player (hh_world_end_step): read it there. While hands move only light bodies, the reported impulses of hands and contacts are limited to the momentum that the players and bodies involved have at their speeds plus the hands' speed.</summary>
        public Vec3 force_impulse_ns;
        /// <summary>false while the hand is lost or inferred</summary>
        public Flag is_tracked;
        /// <summary>the button is down</summary>
        public Flag is_closed;
        /// <summary>The runtime guesses where the hand is (hh_tracking_sample.hand_inferred). `tracked` is the guess for an empty hand, and for a body in it while no hand of the player moves the player; else the last pose that was measured.</summary>
        public Flag is_inferred;
    }

    /// <summary>Grows: see base.h. Later fields come behind `hands`.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct PlayerPose {
        /// <summary>The space of the samples in the world: put the camera rig here. Controllers at origin * sample are where the hands are, also after a recentring, which changes it so that nothing in the world moves.</summary>
        public HhPose origin;
        /// <summary>between the eyes, in the world</summary>
        public HhPose head;
        /// <summary>of the play space</summary>
        public Vec3 velocity_mps;
        /// <summary>by hh_side</summary>
        public HandStateArray2 hands;
    }

    /// <summary>Grows: see base.h. Later versions also have more kinds and reasons: ignore those you do not know.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HhEvent {
        public EventKind kind;
        public Reason reason;
        /// <summary>null: a joint's event that concerns no hand</summary>
        public Player player;
        /// <summary>hh_side; -1: no hand: the head or a joint alone</summary>
        public int side;
        /// <summary>touched, gripped, held or hit; null: a player, or nothing</summary>
        public Body body;
        /// <summary>gripped or hit player; null: none</summary>
        public Player other;
        /// <summary>contacts: what the hand holds; null: the head</summary>
        public Body held;
        /// <summary>whose latch or limit it is; null: none</summary>
        public HhJoint joint;
        /// <summary>in the world: of the wrist, the contact, the joint or the head</summary>
        public Vec3 position;
        /// <summary>of a contact that began: &gt;= 0, for haptics and sound</summary>
        public double impulse_ns;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HandJoint {
        public HhPose pose;
        public double radius_m;
        /// <summary>false: the hand's rig has no such joint</summary>
        public Flag is_valid;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct SkeletonJoint {
        /// <summary>as in the engine's file; null: none</summary>
        public byte* name;
        /// <summary>index; -1: a root</summary>
        public int parent;
        /// <summary>HH_IS_..., for names that nobody can guess. Spine and palms need none: joints of the trunk follow by their height, joints of the palm follow the hand.</summary>
        public int @is;
        /// <summary>In the space given, without scale: T-pose or A-pose, +Y up, of any size and heading.</summary>
        public HhPose bind;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct Finger {
        /// <summary>false: the finger closes on the surface as usual</summary>
        public Flag is_posed;
        /// <summary>of its hinges, from the knuckle; each within pi</summary>
        public DoubleArray3 curl_rad;
        /// <summary>thumb; of a finger: spread towards the thumb, clamped to 0.17</summary>
        public double opposition_rad;
        /// <summary>The finger moves from these angles to the pressed ones as far as the sample's `trigger` is pressed. The pressed angles may reach into the body: a trigger gives way.</summary>
        public Flag follows_trigger;
        public DoubleArray3 pressed_curl_rad;
        public double pressed_opposition_rad;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct GripHand {
        /// <summary>false: this hand cannot take the grip</summary>
        public Flag is_used;
        /// <summary>in the body's frame</summary>
        public HhPose wrist;
        /// <summary>thumb, index, middle, ring, little</summary>
        public FingerArray5 fingers;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct GripDef {
        public uint struct_size;
        /// <summary>by hh_side</summary>
        public GripHandArray2 hands;
        /// <summary>of several in reach, the highest is taken</summary>
        public int priority;
        /// <summary>of the palm, [0, 10]; default 0.08</summary>
        public double snap_radius_m;
        /// <summary>[0, pi]; default pi / 3</summary>
        public double snap_angle_rad;

        /// <summary>The library's defaults.</summary>
        public static GripDef Default() {
            GripDef filled;
            Library.Check(Native.hh_default_grip_def_sized(&filled, (UIntPtr)sizeof(GripDef)));
            return filled;
        }
    }

    /// <summary>What a query found. Ignored, and counted as surface_answer_invalid: a body that is not in the world, numbers that are not finite, a point beyond 1e9 m, a normal of length zero.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct SurfaceHit {
        public Body body;
        /// <summary>on the surface, in the world</summary>
        public Vec3 point;
        /// <summary>out of the solid or towards the query; need not have length 1</summary>
        public Vec3 normal;
        /// <summary>see each query</summary>
        public double distance_m;
    }

    /// <summary>Queries against the host's surfaces. Each returns true if it found something, and then fills `hit`. `skip`: bodies that count as not there. Called only inside hh_world_step, _step_hands, _begin_step, _end_step, _step_pose_only and hh_hand_find_grip of this world, by the thread that made that call. A query may read the world; calls that change it return HH_ERROR_STATE. Per player and frame: about 3 queries, up to 50 when a hand closes behind walls or among bodies.</summary>
    /// <remarks>For Native: keep the delegates of all functions alive while the library may call them, and make them static methods with
    /// MonoPInvokeCallback for IL2CPP. World.SetSurfaces, Match and Library.SetLog do both.</remarks>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct SurfaceQuery {
        public uint struct_size;
        /// <summary>passed to each of the functions</summary>
        public IntPtr context;
        /// <summary>First surface that the segment hits, from outside or inside. distance_m is not read.</summary>
        public IntPtr cast_ray;
        /// <summary>First impact of a sphere moving along a segment; distance_m: how far its centre has moved. For the distance grab (pull.reach_m above 0), and to keep trunk and legs out of surfaces: about one query per player and frame. Null: neither.</summary>
        public IntPtr cast_sphere;
        /// <summary>Nearest surface point within max_distance_m; distance_m: 0 inside a solid.</summary>
        public IntPtr closest_point;
        /// <summary>Nearest surface point of one body, at any distance; distance_m: 0 inside a solid.</summary>
        public IntPtr closest_point_on;

        /// <summary>The library's defaults.</summary>
        public static SurfaceQuery Default() {
            SurfaceQuery filled;
            Library.Check(Native.hh_default_surface_query_sized(&filled, (UIntPtr)sizeof(SurfaceQuery)));
            return filled;
        }
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct BodyMotion {
        public Body body;
        /// <summary>of the shape's own frame; without a shape: centre of mass and principal axes</summary>
        public HhPose pose;
        public Vec3 velocity_mps;
        public Vec3 angular_velocity_radps;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct HandConstraint {
        public Player player;
        public Side side;
        public Body body;
        public HandRows rows;
        /// <summary>the wrist in the body's frame</summary>
        public HhPose anchor;
        /// <summary>the wrist at the end of the step: from the origin, with the world's axes</summary>
        public HhPose target;
        /// <summary>The target's velocity relative to the origin: the throwing velocity while a hand lets go, else the mean over the step.</summary>
        public Vec3 velocity_mps;
        public Vec3 angular_velocity_radps;
        /// <summary>in the world, at the end of the step; not for POINT</summary>
        public Quat body_rotation;
        /// <summary>reaches body_rotation; not for POINT</summary>
        public Vec3 body_angular_velocity_radps;
        /// <summary>The anchor in the world at the end of the step, if the body keeps its velocity. Exact for static and kinematic bodies: a joint may attach the player to this point of the world.</summary>
        public HhPose anchor_end;
        /// <summary>of the rows; 0: rigid, as in the runtime's own solver</summary>
        public double compliance_m_per_n;
        /// <summary>enough to stop what the hand drives from its highest speed in one step</summary>
        public double max_force_n;
        /// <summary>the hand lets go in this step</summary>
        public Flag is_releasing;
    }

    /// <summary>A player's body in the host's solver.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct PlayerMotion {
        public Player player;
        /// <summary>at the start of the step</summary>
        public Vec3 origin;
        /// <summary>at the start of the step, with thrusters and drag applied</summary>
        public Vec3 velocity_mps;
        /// <summary>For this step. The player's own while a hand grips something static, kinematic or at least phases.heavy_body_kg. Else 1000 times the heaviest held body, so that light bodies do not shake the player; for bodies from phases.kappa_light_kg to phases.kappa_heavy_kg it falls to the player's own. If a held body meets something that does not give way, such as a crate at a wall, solve the step again with hh_player_def.mass_kg: the player then moves back by what the body could not move. Without that, hand and wall press against each other without a bound.</summary>
        public double mass_kg;
        /// <summary>of the head's centre: from the origin, with the world's axes</summary>
        public HhPose head;
        /// <summary>the host may let this sphere collide, on the player's body</summary>
        public double head_radius_m;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct SolvedPlayer {
        public Player player;
        /// <summary>at the end of the step</summary>
        public Vec3 origin;
        /// <summary>at the end of the step</summary>
        public Vec3 velocity_mps;
    }

    /// <summary>A velocity that the host gives its body.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct VelocityChange {
        public Body body;
        public Vec3 velocity_mps;
        public Vec3 angular_velocity_radps;
    }

    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MatchDef {
        public uint struct_size;
        /// <summary>default HH_MATCH_CLIENT</summary>
        public MatchRole role;
        /// <summary>by slot, the same on every machine; copied. All are in the world, also while nobody plays them</summary>
        public Player* players;
        /// <summary>[1, HH_MATCH_PLAYERS]</summary>
        public UIntPtr player_count;
        /// <summary>length of a tick, [1e-3, 0.1]; default 1/90</summary>
        public double tick_s;
        /// <summary>client: this machine's player; default 0</summary>
        public uint slot;
        /// <summary>sync test: ticks stepped again each time, [1, 62]; default 8</summary>
        public uint sync_ticks;
        /// <summary>server: time on its clock at the world's present tick; default 0</summary>
        public double start_s;

        /// <summary>The library's defaults.</summary>
        public static MatchDef Default() {
            MatchDef filled;
            Library.Check(Native.hh_default_match_def_sized(&filled, (UIntPtr)sizeof(MatchDef)));
            return filled;
        }
    }

    /// <summary>Your own state of the match, such as scores and doors' codes, which goes back and forth with the world's. Null functions are not called; `save` and `restore` come together. Inside of them no function of the match may be called, and none that steps, restores or destroys the world.</summary>
    /// <remarks>For Native: keep the delegates of all functions alive while the library may call them, and make them static methods with
    /// MonoPInvokeCallback for IL2CPP. World.SetSurfaces, Match and Library.SetLog do both.</remarks>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MatchGame {
        public uint struct_size;
        /// <summary>passed to each of the functions</summary>
        public IntPtr context;
        /// <summary>Called after each step of the world to `tick`, also when it is stepped again. May read the world and its events, and may change its bodies, joints, grips and players; it must not add or remove any. What it does may depend on the world, your state, `tick` and `buttons` only: hh_match_input.buttons of each slot, of which there are `button_count`. What hosts draw, such as hh_player_pose, differs between machines.</summary>
        public IntPtr step;
        /// <summary>Keeps a copy of your state in a place of yours, [0, HH_MATCH_PLACES), over the one before. A server saves nothing.</summary>
        public IntPtr save;
        /// <summary>Sets your state to the copy in that place.</summary>
        public IntPtr restore;
        /// <summary>Hash of your state: machines compare it together with the world's.</summary>
        public IntPtr hash;

        /// <summary>The library's defaults.</summary>
        public static MatchGame Default() {
            MatchGame filled;
            Library.Check(Native.hh_default_match_game_sized(&filled, (UIntPtr)sizeof(MatchGame)));
            return filled;
        }
    }

    /// <summary>A player's input for one tick. Fill by hh_default_match_input.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MatchInput {
        public uint struct_size;
        /// <summary>your bits, for hh_match_game.step</summary>
        public uint buttons;
        /// <summary>As in hh_player_input, on the world's clock: a sample at the tick's end has hh_world_time plus tick_s. Later ones are kept for later ticks, at most 64. Poses become integers of 0.1 mm and 1 mrad, the same on every machine. Without a sample for 0.1 s devices count as not tracked.</summary>
        public TrackingSample* samples;
        public UIntPtr sample_count;
        /// <summary>True: the tick is not shown, as by hh_world_step_simulated. For all but the last of several ticks in one frame. Default false.</summary>
        public Flag is_hidden;
        public Commands commands;

        /// <summary>The library's defaults.</summary>
        public static MatchInput Default() {
            MatchInput filled;
            Library.Check(Native.hh_default_match_input_sized(&filled, (UIntPtr)sizeof(MatchInput)));
            return filled;
        }
    }

    /// <summary>The first tick whose hash changed when it was stepped again.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MatchDifference {
        /// <summary>0: none</summary>
        public ulong tick;
        /// <summary>hh_world_simulated_hash differs</summary>
        public Flag in_world;
        /// <summary>hh_match_game.hash differs</summary>
        public Flag in_game;
    }

    /// <summary>Grows with hh_event, its last field.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MatchEvent {
        public ulong tick;
        public MatchEventState state;
        /// <summary>`position` is that of the tracked hand, not of the shown one</summary>
        public HhEvent @event;
    }

    /// <summary>Counts since the match began, where nothing else is said.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public unsafe partial struct MatchStats {
        public uint struct_size;
        /// <summary>the world's present tick</summary>
        public ulong tick;
        /// <summary>the last tick whose state is final here</summary>
        public ulong confirmed;
        /// <summary>ticks that the world advanced</summary>
        public ulong ticks;
        /// <summary>clients, sync tests: times that the world went back</summary>
        public ulong rollbacks;
        /// <summary>ticks stepped again by them</summary>
        public ulong steps_again;
        /// <summary>most ticks that one of them stepped again</summary>
        public ulong deepest;
        /// <summary>clients: hh_match_advance that were too far ahead</summary>
        public ulong waits;
        /// <summary>inputs that came too late: own ones, or on a server those of all</summary>
        public ulong filled;
        /// <summary>servers, spectators: compared hashes</summary>
        public ulong hashes;
        /// <summary>servers, spectators: those that differed</summary>
        public ulong out_of_sync;
        /// <summary>packets, by hh_match_refusal; on clients, GAP counts their parts</summary>
        public UlongArray16 refused;

        /// <summary>The library's defaults.</summary>
        public static MatchStats Default() {
            MatchStats filled;
            Library.Check(Native.hh_default_match_stats_sized(&filled, (UIntPtr)sizeof(MatchStats)));
            return filled;
        }
    }

    /// <summary>5 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct FingerArray5 {
        private Finger e0, e1, e2, e3, e4;
        public const int Length = 5;
        public Finger this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    case 2: return e2;
                    case 3: return e3;
                    case 4: return e4;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    case 2: e2 = value; break;
                    case 3: e3 = value; break;
                    case 4: e4 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>2 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct FingerCurlsArray2 {
        private FingerCurls e0, e1;
        public const int Length = 2;
        public FingerCurls this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>2 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct FlagArray2 {
        private Flag e0, e1;
        public const int Length = 2;
        public Flag this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>2 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct GripHandArray2 {
        private GripHand e0, e1;
        public const int Length = 2;
        public GripHand this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>2 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct HandStateArray2 {
        private HandState e0, e1;
        public const int Length = 2;
        public HandState this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>2 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct HhPoseArray2 {
        private HhPose e0, e1;
        public const int Length = 2;
        public HhPose this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>4 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Vec3Array4 {
        private Vec3 e0, e1, e2, e3;
        public const int Length = 4;
        public Vec3 this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    case 2: return e2;
                    case 3: return e3;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    case 2: e2 = value; break;
                    case 3: e3 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>2 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct DoubleArray2 {
        private double e0, e1;
        public const int Length = 2;
        public double this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>3 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct DoubleArray3 {
        private double e0, e1, e2;
        public const int Length = 3;
        public double this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    case 2: return e2;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    case 2: e2 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>5 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct DoubleArray5 {
        private double e0, e1, e2, e3, e4;
        public const int Length = 5;
        public double this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    case 2: return e2;
                    case 3: return e3;
                    case 4: return e4;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    case 2: e2 = value; break;
                    case 3: e3 = value; break;
                    case 4: e4 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>16 elements inside of a struct. Write an element by its index; to change a part of it, read, change, write.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct UlongArray16 {
        private ulong e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12, e13, e14, e15;
        public const int Length = 16;
        public ulong this[int index] {
            get {
                switch (index) {
                    case 0: return e0;
                    case 1: return e1;
                    case 2: return e2;
                    case 3: return e3;
                    case 4: return e4;
                    case 5: return e5;
                    case 6: return e6;
                    case 7: return e7;
                    case 8: return e8;
                    case 9: return e9;
                    case 10: return e10;
                    case 11: return e11;
                    case 12: return e12;
                    case 13: return e13;
                    case 14: return e14;
                    case 15: return e15;
                    default: throw new IndexOutOfRangeException();
                }
            }
            set {
                switch (index) {
                    case 0: e0 = value; break;
                    case 1: e1 = value; break;
                    case 2: e2 = value; break;
                    case 3: e3 = value; break;
                    case 4: e4 = value; break;
                    case 5: e5 = value; break;
                    case 6: e6 = value; break;
                    case 7: e7 = value; break;
                    case 8: e8 = value; break;
                    case 9: e9 = value; break;
                    case 10: e10 = value; break;
                    case 11: e11 = value; break;
                    case 12: e12 = value; break;
                    case 13: e13 = value; break;
                    case 14: e14 = value; break;
                    case 15: e15 = value; break;
                    default: throw new IndexOutOfRangeException();
                }
            }
        }
    }

    /// <summary>The functions as they are: nothing is checked, and nothing is allocated.</summary>
    public static unsafe class Native {
#if (UNITY_IOS || UNITY_TVOS || UNITY_VISIONOS || UNITY_WEBGL) && !UNITY_EDITOR
        public const string LibraryName = "__Internal";
#else
        public const string LibraryName = "handhold";
#endif
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_result_text(Result result);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_last_error();
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern void hh_version(uint* major, uint* minor, uint* patch);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern HhPose hh_identity_pose();
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern void hh_sin_cos(double angle_rad, double* sine, double* cosine);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern double hh_atan2(double y, double x);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_host_hooks_sized(HostHooks* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_set_host_hooks(HostHooks* hooks);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_set_thread_count(uint count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint hh_thread_count();
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern double hh_convert_metres_per_unit(Engine engine);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_vector_from(Engine engine, Vec3 vector);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_vector_to(Engine engine, Vec3 vector);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_direction_from(Engine engine, Vec3 direction);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_direction_to(Engine engine, Vec3 direction);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_angular_from(Engine engine, Vec3 angular_radps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_angular_to(Engine engine, Vec3 angular_radps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Quat hh_convert_rotation_from(Engine engine, Quat rotation);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Quat hh_convert_rotation_to(Engine engine, Quat rotation);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern HhPose hh_convert_pose_from(Engine engine, HhPose pose);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern HhPose hh_convert_pose_to(Engine engine, HhPose pose);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_scale_from(Engine engine, Vec3 scale);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Vec3 hh_convert_scale_to(Engine engine, Vec3 scale);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_convert_mesh_from(Engine engine, float* coordinates, UIntPtr coordinate_count, uint* indices, UIntPtr index_count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_world_def_sized(WorldDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_create(WorldDef* def, IntPtr* world);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern void hh_world_destroy(IntPtr world);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_tracking_sample_sized(TrackingSample* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_player_input_sized(PlayerInput* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_step(IntPtr world, double dt_s, PlayerInput* inputs, UIntPtr input_count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_step_simulated(IntPtr world, double dt_s, PlayerInput* inputs, UIntPtr input_count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_step_pose_only(IntPtr world, double dt_s, PlayerInput* inputs, UIntPtr input_count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_time(IntPtr world, double* time_s, ulong* frame);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_set_gravity(IntPtr world, Vec3 gravity_mps2);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_set_reference_velocity(IntPtr world, Vec3 velocity_mps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_gravity(IntPtr world, Vec3* gravity_mps2);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_reference_velocity(IntPtr world, Vec3* velocity_mps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_hash(IntPtr world, ulong* hash);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_simulated_hash(IntPtr world, ulong* hash);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_save(IntPtr world, void* buffer, UIntPtr capacity, UIntPtr* size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_restore(IntPtr world, void* bytes, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_world_stats_sized(WorldStats* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_get_stats(IntPtr world, WorldStats* stats);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_stage_name(UIntPtr stage);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_fallback_name(UIntPtr fallback);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_stage_times(IntPtr world, double* us, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_fallbacks(IntPtr world, ulong* times, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_tuning_info_sized(TuningInfo* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_tuning_describe(UIntPtr index, TuningInfo* info);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_get_tuning(IntPtr world, byte* name, double* values, UIntPtr count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_set_tuning(IntPtr world, byte* name, double* values, UIntPtr count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_tuning_numbers(IntPtr world, double* values, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_set_tuning_numbers(IntPtr world, double* values, UIntPtr count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_load_tuning(IntPtr world, byte* json, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_load_body_clips(IntPtr world, byte* json, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_box(IntPtr world, Vec3 half_extents_m, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_sphere(IntPtr world, double radius_m, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_capsule(IntPtr world, double radius_m, double half_height_m, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_cylinder(IntPtr world, double radius_m, double half_height_m, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_hull(IntPtr world, Vec3* points, UIntPtr count, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_compound(IntPtr world, CompoundPart* parts, UIntPtr count, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_mesh_def_sized(MeshDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_mesh_create(MeshDef* def, IntPtr* mesh);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern void hh_mesh_destroy(IntPtr mesh);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_add_mesh(IntPtr world, IntPtr mesh, Vec3 scale, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_shape_remove(IntPtr world, Shape shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte hh_shape_is_valid(IntPtr world, Shape shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_shape_count(IntPtr world, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_body_def_sized(BodyDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_add(IntPtr world, BodyDef* def, Body* body);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_remove(IntPtr world, Body body);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte hh_body_is_valid(IntPtr world, Body body);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_find(IntPtr world, byte* name, Body* body);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_name(IntPtr world, Body body, byte** name);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_bodies(IntPtr world, Body* bodies, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_pose(IntPtr world, Body body, HhPose* pose);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_body_poses(IntPtr world, Body* bodies, UIntPtr count, HhPose* poses);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_velocity(IntPtr world, Body body, Vec3* velocity_mps, Vec3* angular_velocity_radps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_velocity(IntPtr world, Body body, Vec3 velocity_mps, Vec3 angular_velocity_radps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_apply_impulse(IntPtr world, Body body, Vec3 impulse_ns, Vec3 point);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_teleport(IntPtr world, Body body, HhPose pose);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_move_kinematic(IntPtr world, Body body, HhPose pose);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_gravity_scale(IntPtr world, Body body, double scale);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_layers(IntPtr world, Body body, uint layers, uint mask);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_grab_rule(IntPtr world, Body body, byte left, byte right, byte two_hands, int priority);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_get_kind(IntPtr world, Body body, BodyKind* kind);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_mass(IntPtr world, Body body, double* mass_kg);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_mass(IntPtr world, Body body, double mass_kg, Vec3 inertia_kgm2);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_material(IntPtr world, Body body, double* friction, double* restitution);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_material(IntPtr world, Body body, double friction, double restitution);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_kind(IntPtr world, Body body, BodyKind kind, double mass_kg, Vec3 inertia_kgm2);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_shape(IntPtr world, Body body, Shape* shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_shape(IntPtr world, Body body, Shape shape);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_user_data(IntPtr world, Body body, ulong user_data);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_user_data(IntPtr world, Body body, ulong* user_data);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_add_gltf_level(IntPtr world, void* gltf, UIntPtr size, HhPose pose, Body* bodies, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_joint_def_sized(JointDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_add(IntPtr world, JointDef* def, HhJoint* joint);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_remove(IntPtr world, HhJoint joint);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte hh_joint_is_valid(IntPtr world, HhJoint joint);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_joints(IntPtr world, Body body, HhJoint* joints, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_motor_def_sized(MotorDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_set_motor(IntPtr world, HhJoint joint, MotorDef* def);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_set_limits(IntPtr world, HhJoint joint, byte limited, double lower, double upper);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_set_latch(IntPtr world, HhJoint joint, double at, double range, double strength);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_set_friction(IntPtr world, HhJoint joint, double friction);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_joint_state(IntPtr world, HhJoint joint, double* coordinate, double* speed, byte* latched);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_contacts(IntPtr world, Contact* contacts, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_cast_ray(IntPtr world, Vec3 from, Vec3 to, Player skip, Hit* hit);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_cast_sphere(IntPtr world, double radius_m, Vec3 from, Vec3 to, Player skip, Hit* hit);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_closest_point(IntPtr world, Vec3 point, double max_distance_m, Player skip, Hit* hit);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_overlap_sphere(IntPtr world, Vec3 center, double radius_m, Player skip, Hit* hits, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_player_def_sized(PlayerDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_add(IntPtr world, PlayerDef* def, Player* player);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_remove(IntPtr world, Player player);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte hh_player_is_valid(IntPtr world, Player player);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_players(IntPtr world, Player* players, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_recenter(IntPtr world, Player player, HhPose new_in_old);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_recenter_guess(IntPtr world, Player player, byte guesses);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_teleport(IntPtr world, Player player, HhPose origin);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_velocity(IntPtr world, Player player, Vec3* velocity_mps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_velocity(IntPtr world, Player player, Vec3 velocity_mps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_reference_velocity(IntPtr world, Player player, Vec3* velocity_mps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_push_back(IntPtr world, Player player, double* distance_m);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_mass(IntPtr world, Player player, double* mass_kg);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_head(IntPtr world, Player player, Vec3* center, double* radius_m, byte* is_tracked);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_measures(IntPtr world, Player player, Measures* measures);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_measures(IntPtr world, Player player, Measures* measures);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_user_data(IntPtr world, Player player, ulong user_data);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_user_data(IntPtr world, Player player, ulong* user_data);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_hand_in_controller(IntPtr world, Player player, Side side, HhPose* hand_in_controller);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_hand_in_controller(IntPtr world, Player player, Side side, HhPose* hand_in_controller);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_hand_in_controller(IntPtr world, Side side, HhPose* hand_in_controller);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_hand_sized(IntPtr world, Player player, Side side, HandState* hand, UIntPtr hand_size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_hand_moves_player(IntPtr world, Player player, Side side, byte* moves_player);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_player_poses_sized(IntPtr world, Player* players, UIntPtr count, PlayerPose* poses, UIntPtr pose_size, UIntPtr hand_size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_hand_grip(IntPtr world, Player player, Side side, Body body);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_hand_release(IntPtr world, Player player, Side side);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_event_kind_name(EventKind kind);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_reason_name(Reason reason);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_events_sized(IntPtr world, HhEvent** events, UIntPtr* count, UIntPtr event_size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_finger_curls_of(HandJoint* joints, FingerCurls* curls);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_hand_joints(IntPtr world, Player player, Side side, HhSpace space, HandJoint* joints);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern byte* hh_body_joint_name(UIntPtr joint);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern int hh_body_joint_parent(UIntPtr joint);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_body_joints(IntPtr world, Player player, HhSpace space, HhPose* joints);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_hand_rig(IntPtr world, Player player, Side side, void* gltf, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_body_rig(IntPtr world, Player player, void* gltf, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_set_body_skeleton(IntPtr world, Player player, SkeletonJoint* joints, UIntPtr count, HhSpace space);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_skeleton(IntPtr world, Player player, HhSpace space, HhPose* joints, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_skeleton_joint(IntPtr world, Player player, UIntPtr joint, byte** name, int* parent);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_skeleton_fingers(IntPtr world, Player player, Side side, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_grip_def_sized(GripDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_add_grip(IntPtr world, Body body, GripDef* def);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_surface_query_sized(SurfaceQuery* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_set_surface_query(IntPtr world, SurfaceQuery* query);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_body_set_surface(IntPtr world, Body body, IntPtr mesh);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_place_bodies(IntPtr world, BodyMotion* motions, UIntPtr count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_player_place(IntPtr world, Player player, HhPose origin, Vec3 velocity_mps);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_hand_hold(IntPtr world, Player player, Side side, Body body, HhPose* anchor);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_hand_find_grip(IntPtr world, Player player, Side side, SurfaceHit* hit);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_step_hands(IntPtr world, double dt_s, PlayerInput* inputs, UIntPtr input_count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_begin_step(IntPtr world, double dt_s, PlayerInput* inputs, UIntPtr input_count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_hand_constraints(IntPtr world, HandConstraint** constraints, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_player_motions(IntPtr world, PlayerMotion** motions, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_end_step(IntPtr world, SolvedPlayer* players, UIntPtr count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_velocity_changes(IntPtr world, VelocityChange** changes, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_world_held_bodies(IntPtr world, Body* bodies, UIntPtr capacity, UIntPtr* count);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_match_def_sized(MatchDef* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_match_game_sized(MatchGame* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_create(IntPtr world, MatchDef* def, MatchGame* game, IntPtr* match);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern void hh_match_destroy(IntPtr match);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_match_input_sized(MatchInput* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_ticks_due(IntPtr match, double elapsed_s, uint* ticks);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_advance(IntPtr match, MatchInput* input, byte* advanced);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_receive(IntPtr match, void* packet, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_packet(IntPtr match, void* buffer, UIntPtr capacity, UIntPtr* size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_join(IntPtr match, void* bytes, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_connect(IntPtr match, uint slot);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_disconnect(IntPtr match, uint slot);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_receive_from(IntPtr match, uint slot, double now_s, void* packet, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_confirm(IntPtr match, double now_s, uint* ticks);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_packet_to(IntPtr match, uint slot, void* buffer, UIntPtr capacity, UIntPtr* size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_state(IntPtr match, uint slot, void* buffer, UIntPtr capacity, UIntPtr* size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_sync_test(IntPtr match, MatchInput* inputs, UIntPtr input_count, MatchDifference* difference);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_confirmed_inputs(IntPtr match, ulong after, void* buffer, UIntPtr capacity, UIntPtr* size, ulong* until);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_needs_state(IntPtr match, uint slot, byte* needs);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_hash(IntPtr match, ulong tick, ulong* hash);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_shown_offsets(IntPtr match, uint slot, Vec3* head, Vec3* left, Vec3* right);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_drawn_player(IntPtr match, uint slot, TrackingSample* newest, HhPose* origin, HhPose* head, HhPose* left, HhPose* right);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_drawn_bodies(IntPtr match, Body* bodies, UIntPtr count, HhPose* poses);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_events_sized(IntPtr match, MatchEvent** events, UIntPtr* count, UIntPtr event_size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_default_match_stats_sized(MatchStats* filled, UIntPtr size);
        [DllImport(LibraryName, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result hh_match_get_stats(IntPtr match, MatchStats* stats);
    }

    public static partial class Library {

        /// <summary>The result's name, "HH_ERROR_HANDLE". Never null. Any thread.</summary>
        public static unsafe string ResultText(Result result) {
            string answer = Library.Text(Native.hh_result_text(result));
            return answer;
        }

        /// <summary>The version of the library that is running: compare with HANDHOLD_VERSION_MAJOR and so on. Null pointers are skipped. Any thread.</summary>
        public static unsafe void Version(out uint major, out uint minor, out uint patch) {
            uint major_at;
            uint minor_at;
            uint patch_at;
            Native.hh_version(&major_at, &minor_at, &patch_at);
            major = major_at;
            minor = minor_at;
            patch = patch_at;
        }

        /// <summary>The pose at the origin, not rotated. Any thread.</summary>
        public static unsafe HhPose IdentityPose() {
            HhPose answer = Native.hh_identity_pose();
            return answer;
        }

        /// <summary>Equal on every machine and compiler, unlike sin, cos and atan2 of C: for inputs that must replay bit for bit. Errors are below 1e-14 up to 1e6 rad; beyond that, and for NaN, sine is 0 and cosine 1. Null outputs are skipped. hh_atan2 gives 0 for (0, 0) and NaN. Any thread.</summary>
        public static unsafe void SinCos(double angle_rad, out double sine, out double cosine) {
            double sine_at;
            double cosine_at;
            Native.hh_sin_cos(angle_rad, &sine_at, &cosine_at);
            sine = sine_at;
            cosine = cosine_at;
        }

        public static unsafe double Atan2(double y, double x) {
            double answer = Native.hh_atan2(y, x);
            return answer;
        }

        /// <summary>Sets the number of threads of the library's own pool, [1, 256]. Allowed while worlds exist, for instance to use all cores while a level loads. HH_ERROR_STATE if the host lends parallel_for. Not beside any other call of the library.</summary>
        public static unsafe void SetThreadCount(uint count) {
            Library.Check(Native.hh_set_thread_count(count));
        }

        /// <summary>Number of threads of the library's own pool, the caller's included. Any thread.</summary>
        public static unsafe uint ThreadCount() {
            uint answer = Native.hh_thread_count();
            return answer;
        }

        /// <summary>Metres in one of the engine's units of length: 0.01 for Unreal, else 1. For radii and distances.</summary>
        public static unsafe double ConvertMetresPerUnit(Engine engine) {
            double answer = Native.hh_convert_metres_per_unit(engine);
            return answer;
        }

        /// <summary>Whatever scales with length: positions, velocities, accelerations, impulses, forces.</summary>
        public static unsafe Vec3 ConvertVectorFrom(Engine engine, Vec3 vector) {
            Vec3 answer = Native.hh_convert_vector_from(engine, vector);
            return answer;
        }

        public static unsafe Vec3 ConvertVectorTo(Engine engine, Vec3 vector) {
            Vec3 answer = Native.hh_convert_vector_to(engine, vector);
            return answer;
        }

        /// <summary>Directions without a length: normals, axes.</summary>
        public static unsafe Vec3 ConvertDirectionFrom(Engine engine, Vec3 direction) {
            Vec3 answer = Native.hh_convert_direction_from(engine, direction);
            return answer;
        }

        public static unsafe Vec3 ConvertDirectionTo(Engine engine, Vec3 direction) {
            Vec3 answer = Native.hh_convert_direction_to(engine, direction);
            return answer;
        }

        /// <summary>Angular velocities in rad/s, and other vectors along an axis of rotation. Left-handed engines count angles the other way, so the sign changes too.</summary>
        public static unsafe Vec3 ConvertAngularFrom(Engine engine, Vec3 angular_radps) {
            Vec3 answer = Native.hh_convert_angular_from(engine, angular_radps);
            return answer;
        }

        public static unsafe Vec3 ConvertAngularTo(Engine engine, Vec3 angular_radps) {
            Vec3 answer = Native.hh_convert_angular_to(engine, angular_radps);
            return answer;
        }

        public static unsafe Quat ConvertRotationFrom(Engine engine, Quat rotation) {
            Quat answer = Native.hh_convert_rotation_from(engine, rotation);
            return answer;
        }

        public static unsafe Quat ConvertRotationTo(Engine engine, Quat rotation) {
            Quat answer = Native.hh_convert_rotation_to(engine, rotation);
            return answer;
        }

        public static unsafe HhPose ConvertPoseFrom(Engine engine, HhPose pose) {
            HhPose answer = Native.hh_convert_pose_from(engine, pose);
            return answer;
        }

        public static unsafe HhPose ConvertPoseTo(Engine engine, HhPose pose) {
            HhPose answer = Native.hh_convert_pose_to(engine, pose);
            return answer;
        }

        /// <summary>Scale factors of an object along its own axes, and half extents in metres: axes change places, signs do not.</summary>
        public static unsafe Vec3 ConvertScaleFrom(Engine engine, Vec3 scale) {
            Vec3 answer = Native.hh_convert_scale_from(engine, scale);
            return answer;
        }

        public static unsafe Vec3 ConvertScaleTo(Engine engine, Vec3 scale) {
            Vec3 answer = Native.hh_convert_scale_to(engine, scale);
            return answer;
        }

        /// <summary>Converts a mesh in place: x, y, z of its vertices. Reverses its triangles if the engine's front faces are clockwise (Unity, Godot), so that they are counter-clockwise from outside. A mirrored object, of which the product of the scales is negative, needs nothing else: give its scale, from hh_convert_scale_from, to hh_shape_add_mesh, which takes negative factors. HH_ERROR_VALUE, and no change, for counts that are no multiples of 3.</summary>
        public static unsafe void ConvertMeshFrom(Engine engine, float[] coordinates, uint[] indices) {
            fixed (float* coordinates_at = coordinates) {
                fixed (uint* indices_at = indices) {
                    Library.Check(Native.hh_convert_mesh_from(engine, coordinates_at, Library.Count(coordinates), indices_at, Library.Count(indices)));
                }
            }
        }

        /// <summary>Stages and fallbacks by index; null beyond the last. A fallback is counted whenever the runtime does the next best instead of what was asked. Any thread.</summary>
        public static unsafe string StageName(long stage) {
            string answer = Library.Text(Native.hh_stage_name((UIntPtr)(ulong)stage));
            return answer;
        }

        public static unsafe string FallbackName(long fallback) {
            string answer = Library.Text(Native.hh_fallback_name((UIntPtr)(ulong)fallback));
            return answer;
        }

        /// <summary>The number with this index; HH_ERROR_VALUE beyond the last. Any thread.</summary>
        public static unsafe TuningInfo TuningDescribe(long index) {
            TuningInfo info;
            TuningInfo info_at = TuningInfo.Default();
            Library.Check(Native.hh_tuning_describe((UIntPtr)(ulong)index, &info_at));
            info = info_at;
            return info;
        }

        /// <summary>"grabbed", "no_surface"; null for numbers that this version does not know. Any thread.</summary>
        public static unsafe string EventKindName(EventKind kind) {
            string answer = Library.Text(Native.hh_event_kind_name(kind));
            return answer;
        }

        public static unsafe string ReasonName(Reason reason) {
            string answer = Library.Text(Native.hh_reason_name(reason));
            return answer;
        }

        /// <summary>How far the fingers of a tracked hand are bent, for hh_tracking_sample.curls. `joints`: HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name, in any one space; only positions are read. Curl is the sum of a finger's bends over that of a fist; -1 if a joint of the finger is not valid. Any thread.</summary>
        public static unsafe FingerCurls FingerCurlsOf(HandJoint[] joints) {
            FingerCurls curls;
            Library.RequireLength(joints, 26, "joints");
            FingerCurls curls_at;
            fixed (HandJoint* joints_at = joints) {
                Library.Check(Native.hh_finger_curls_of(joints_at, &curls_at));
                curls = curls_at;
            }
            return curls;
        }

        /// <summary>"leftUpperArm"; null beyond the last. Any thread.</summary>
        public static unsafe string BodyJointName(long joint) {
            string answer = Library.Text(Native.hh_body_joint_name((UIntPtr)(ulong)joint));
            return answer;
        }

        /// <summary>The parent's index; -1 for the hips and beyond the last.</summary>
        public static unsafe int BodyJointParent(long joint) {
            int answer = Native.hh_body_joint_parent((UIntPtr)(ulong)joint);
            return answer;
        }
    }

    public partial class World {

        /// <summary>Steps the world by dt_s, in [1e-6, 10]; 1/90 is usual. `inputs`: at most one a player, else HH_ERROR_VALUE; players without one are silent. Bad samples are ignored and counted; numbers in commands that are out of range are clamped. Cost: about 0.03 ms for a player who crawls, 0.05 ms for one who grips and lets go all the time, and up to 4 ms in the frame in which a hand closes: docs/guide/cost.md.</summary>
        public unsafe void Step(double dt_s, PlayerInput[] inputs) {
            fixed (PlayerInput* inputs_at = inputs) {
                Library.Check(Native.hh_world_step(Handle, dt_s, inputs_at, Library.Count(inputs)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>hh_world_step without fitted hands, arms, spine and legs: about a quarter of its cost. What hosts draw stays as the last other step left it: hh_player_pose with its hands, joints of hands and bodies, hh_player_push_back. Everything else changes exactly as in hh_world_step, bit for bit: hh_world_simulated_hash is equal whichever steps were shown. For rollback: step again to the present with this, and the last time with hh_world_step. Events carry the tracked hand's position.</summary>
        public unsafe void StepSimulated(double dt_s, PlayerInput[] inputs) {
            fixed (PlayerInput* inputs_at = inputs) {
                Library.Check(Native.hh_world_step_simulated(Handle, dt_s, inputs_at, Library.Count(inputs)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>While the game is paused: heads, hands and bodies of players follow their last sample, whatever its time. The clock, bodies, joints, grips and play spaces stand still. Samples that were waiting for their step are dropped. The next hh_world_step goes on: hands that are still closed grip where they are at that time.</summary>
        public unsafe void StepPoseOnly(double dt_s, PlayerInput[] inputs) {
            fixed (PlayerInput* inputs_at = inputs) {
                Library.Check(Native.hh_world_step_pose_only(Handle, dt_s, inputs_at, Library.Count(inputs)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>The world's clock, seconds, and the number of steps. Null outputs are skipped.</summary>
        public unsafe void Time(out double time_s, out ulong frame) {
            double time_s_at;
            ulong frame_at;
            Library.Check(Native.hh_world_time(Handle, &time_s_at, &frame_at));
            time_s = time_s_at;
            frame = frame_at;
            GC.KeepAlive(this);
        }

        /// <summary>Acceleration of dynamic bodies; players float. Each axis within 1e4 m/s^2.</summary>
        public unsafe void SetGravity(Vec3 gravity_mps2) {
            Library.Check(Native.hh_world_set_gravity(Handle, gravity_mps2));
            GC.KeepAlive(this);
        }

        /// <summary>Velocity of the scene: drifting players come to rest against it. Each axis within 1e6 m/s.</summary>
        public unsafe void SetReferenceVelocity(Vec3 velocity_mps) {
            Library.Check(Native.hh_world_set_reference_velocity(Handle, velocity_mps));
            GC.KeepAlive(this);
        }

        public unsafe Vec3 Gravity() {
            Vec3 gravity_mps2;
            Vec3 gravity_mps2_at;
            Library.Check(Native.hh_world_gravity(Handle, &gravity_mps2_at));
            gravity_mps2 = gravity_mps2_at;
            GC.KeepAlive(this);
            return gravity_mps2;
        }

        public unsafe Vec3 ReferenceVelocity() {
            Vec3 velocity_mps;
            Vec3 velocity_mps_at;
            Library.Check(Native.hh_world_reference_velocity(Handle, &velocity_mps_at));
            velocity_mps = velocity_mps_at;
            GC.KeepAlive(this);
            return velocity_mps;
        }

        /// <summary>Hash of the whole state. Equal on every machine, compiler and number of threads after equal calls with equal names. Not in it: which shape a body has, because ids depend on the order of loading. Cost: linear in the state, about 0.1 ms for a scene of 100 bodies.</summary>
        public unsafe ulong Hash() {
            ulong hash;
            ulong hash_at;
            Library.Check(Native.hh_world_hash(Handle, &hash_at));
            hash = hash_at;
            GC.KeepAlive(this);
            return hash;
        }

        /// <summary>The same of the simulated state alone, without what hosts draw. Machines that show different frames, or none, compare this.</summary>
        public unsafe ulong SimulatedHash() {
            ulong hash;
            ulong hash_at;
            Library.Check(Native.hh_world_simulated_hash(Handle, &hash_at));
            hash = hash_at;
            GC.KeepAlive(this);
            return hash;
        }

        /// <summary>Saves every bit of the state. Writes the number of bytes to `size`. A null `buffer` only asks for it. HH_ERROR_CAPACITY if it is more than `capacity`. Rigs, tuning and user data are not in a snapshot. Shapes are named by their content: a world that restores it needs equal ones, whatever their ids.</summary>
        public unsafe byte[] Save() {
            byte[] buffer;
            UIntPtr size_at;
            Library.Check(Native.hh_world_save(Handle, null, UIntPtr.Zero, &size_at));
            byte[] made = new byte[(long)size_at];
            fixed (byte* made_at = made) { Library.Check(Native.hh_world_save(Handle, made_at, size_at, &size_at)); }
            Array.Resize(ref made, (int)size_at);
            buffer = made;
            GC.KeepAlive(this);
            return buffer;
        }

        /// <summary>Back to a saved state, which then goes on bit for bit. Ids taken before the save are valid again. HH_ERROR_DATA, and no change, for bytes that are damaged or name a shape that this world has not. Tolerates any bytes.</summary>
        public unsafe void Restore(byte[] bytes) {
            fixed (byte* bytes_at = bytes) {
                Library.Check(Native.hh_world_restore(Handle, bytes_at, Library.Count(bytes)));
                GC.KeepAlive(this);
            }
        }

        public unsafe WorldStats GetStats() {
            WorldStats stats;
            WorldStats stats_at = WorldStats.Default();
            Library.Check(Native.hh_world_get_stats(Handle, &stats_at));
            stats = stats_at;
            GC.KeepAlive(this);
            return stats;
        }

        /// <summary>Time of each stage, microseconds, and how often each fallback occurred, in the last step. `count` gets the number of entries; HH_ERROR_CAPACITY if it is more than `capacity`.</summary>
        public unsafe double[] StageTimes() {
            double[] us;
            UIntPtr count_at;
            Library.Check(Native.hh_world_stage_times(Handle, null, UIntPtr.Zero, &count_at));
            double[] made = new double[(long)count_at];
            fixed (double* made_at = made) { Library.Check(Native.hh_world_stage_times(Handle, made_at, count_at, &count_at)); }
            us = made;
            GC.KeepAlive(this);
            return us;
        }

        public unsafe ulong[] Fallbacks() {
            ulong[] times;
            UIntPtr count_at;
            Library.Check(Native.hh_world_fallbacks(Handle, null, UIntPtr.Zero, &count_at));
            ulong[] made = new ulong[(long)count_at];
            fixed (ulong* made_at = made) { Library.Check(Native.hh_world_fallbacks(Handle, made_at, count_at, &count_at)); }
            times = made;
            GC.KeepAlive(this);
            return times;
        }

        /// <summary>Reads and changes one number by name, between steps. `count` must be the number's. HH_ERROR_NAME for an unknown name, HH_ERROR_VALUE out of range.</summary>
        public unsafe double[] GetTuning(string name, int count) {
            double[] values;
            double[] values_made = new double[count];
            fixed (byte* name_at = Library.Text(name)) {
                fixed (double* values_at = values_made) {
                    Library.Check(Native.hh_world_get_tuning(Handle, name_at, values_at, (UIntPtr)(uint)count));
                    values = values_made;
                    GC.KeepAlive(this);
                }
            }
            return values;
        }

        public unsafe void SetTuning(string name, double[] values) {
            fixed (byte* name_at = Library.Text(name)) {
                fixed (double* values_at = values) {
                    Library.Check(Native.hh_world_set_tuning(Handle, name_at, values_at, Library.Count(values)));
                    GC.KeepAlive(this);
                }
            }
        }

        /// <summary>All numbers of the tuning, to compare, keep and restore: in the order of hh_tuning_describe, a vector as three. `count` as for hh_world_fallbacks. Set takes exactly all of them; on an error none changes.</summary>
        public unsafe double[] TuningNumbers() {
            double[] values;
            UIntPtr count_at;
            Library.Check(Native.hh_world_tuning_numbers(Handle, null, UIntPtr.Zero, &count_at));
            double[] made = new double[(long)count_at];
            fixed (double* made_at = made) { Library.Check(Native.hh_world_tuning_numbers(Handle, made_at, count_at, &count_at)); }
            values = made;
            GC.KeepAlive(this);
            return values;
        }

        public unsafe void SetTuningNumbers(double[] values) {
            fixed (double* values_at = values) {
                Library.Check(Native.hh_world_set_tuning_numbers(Handle, values_at, Library.Count(values)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>All numbers from JSON, {"hand": {"reach_m": 0.12}}; those that it lacks get their defaults. HH_ERROR_DATA, with the place, for unknown names and wrong numbers.</summary>
        public unsafe void LoadTuning(byte[] json) {
            fixed (byte* json_at = json) {
                Library.Check(Native.hh_world_load_tuning(Handle, json_at, Library.Count(json)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>The additive body clips of all players, from JSON in the format of docs/reference/body_clips.md: idling, pushing off, looking round, raising the arms. They rotate spine, legs and clavicles, never hands. They replace the clips before. Null: none, which is the default. HH_ERROR_DATA, with the place and no change, for anything else. Clips are not in a snapshot: load the same ones before you restore.</summary>
        public unsafe void LoadBodyClips(byte[] json) {
            fixed (byte* json_at = json) {
                Library.Check(Native.hh_world_load_body_clips(Handle, json_at, Library.Count(json)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>In a world with fits_hands, a new shape gets a surface for hands on the calling thread; a shape equal to one that is there costs microseconds. Costs are of one core at 2.1 GHz. Large round shapes cost more than a frame: add them while loading. Box: 0.02 ms.</summary>
        public unsafe Shape ShapeAddBox(Vec3 half_extents_m) {
            Shape shape;
            Shape shape_at;
            Library.Check(Native.hh_shape_add_box(Handle, half_extents_m, &shape_at));
            shape = shape_at;
            GC.KeepAlive(this);
            return shape;
        }

        /// <summary>Cost with fits_hands: 2 ms at 0.1 m, growing with the radius to 18 ms at 1 m; none above 64 m.</summary>
        public unsafe Shape ShapeAddSphere(double radius_m) {
            Shape shape;
            Shape shape_at;
            Library.Check(Native.hh_shape_add_sphere(Handle, radius_m, &shape_at));
            shape = shape_at;
            GC.KeepAlive(this);
            return shape;
        }

        /// <summary>Along Y; half_height_m without the caps. Cost: as a sphere.</summary>
        public unsafe Shape ShapeAddCapsule(double radius_m, double half_height_m) {
            Shape shape;
            Shape shape_at;
            Library.Check(Native.hh_shape_add_capsule(Handle, radius_m, half_height_m, &shape_at));
            shape = shape_at;
            GC.KeepAlive(this);
            return shape;
        }

        /// <summary>Along Y. Cost with fits_hands: 0.4 ms at 0.1 m.</summary>
        public unsafe Shape ShapeAddCylinder(double radius_m, double half_height_m) {
            Shape shape;
            Shape shape_at;
            Library.Check(Native.hh_shape_add_cylinder(Handle, radius_m, half_height_m, &shape_at));
            shape = shape_at;
            GC.KeepAlive(this);
            return shape;
        }

        /// <summary>Convex hull of points that are not coplanar. Cost with fits_hands: 1.6 ms for 64 points.</summary>
        public unsafe Shape ShapeAddHull(Vec3[] points) {
            Shape shape;
            Shape shape_at;
            fixed (Vec3* points_at = points) {
                Library.Check(Native.hh_shape_add_hull(Handle, points_at, Library.Count(points), &shape_at));
                shape = shape_at;
                GC.KeepAlive(this);
            }
            return shape;
        }

        /// <summary>1 to 64 parts that move as one. It keeps copies: the parts may be removed. Cost with fits_hands: as if all its parts were new shapes.</summary>
        public unsafe Shape ShapeAddCompound(CompoundPart[] parts) {
            Shape shape;
            Shape shape_at;
            fixed (CompoundPart* parts_at = parts) {
                Library.Check(Native.hh_shape_add_compound(Handle, parts_at, Library.Count(parts), &shape_at));
                shape = shape_at;
                GC.KeepAlive(this);
            }
            return shape;
        }

        /// <summary>A shape of a prepared mesh, for static and kinematic bodies. The size of each factor is in [1e-3, 1e3], others get HH_ERROR_VALUE; negative ones mirror the mesh, whose triangles keep their outer side. Cost: microseconds for scale 1; another scale prepares the hands' surface again, about 40 microseconds a triangle with fits_hands.</summary>
        public unsafe Shape ShapeAddMesh(HhMesh mesh, Vec3 scale) {
            Shape shape;
            Shape shape_at;
            Library.Check(Native.hh_shape_add_mesh(Handle, mesh == null ? IntPtr.Zero : mesh.Handle, scale, &shape_at));
            shape = shape_at;
            GC.KeepAlive(mesh);
            GC.KeepAlive(this);
            return shape;
        }

        /// <summary>HH_ERROR_STATE while a body or a player has the shape.</summary>
        public unsafe void ShapeRemove(Shape shape) {
            Library.Check(Native.hh_shape_remove(Handle, shape));
            GC.KeepAlive(this);
        }

        public unsafe bool ShapeIsValid(Shape shape) {
            bool answer = Native.hh_shape_is_valid(Handle, shape) != 0;
            GC.KeepAlive(this);
            return answer;
        }

        /// <summary>Number of shapes.</summary>
        public unsafe long ShapeCount() {
            long count;
            UIntPtr count_at;
            Library.Check(Native.hh_world_shape_count(Handle, &count_at));
            count = (long)count_at;
            GC.KeepAlive(this);
            return count;
        }

        /// <summary>Adds a body. Cost: constant, whatever else is in the world.</summary>
        public unsafe Body BodyAdd(BodyDef? def, string name = null) {
            Body body;
            BodyDef def_at = def.GetValueOrDefault();
            Body body_at;
            fixed (byte* name_at = Library.Text(name)) {
                if (name != null) def_at.name = name_at;
                Library.Check(Native.hh_body_add(Handle, def.HasValue ? &def_at : null, &body_at));
                body = body_at;
                GC.KeepAlive(this);
            }
            return body;
        }

        /// <summary>Removes a body with its joints. Hands that grip it are empty at once; the event follows in the next step.</summary>
        public unsafe void BodyRemove(Body body) {
            Library.Check(Native.hh_body_remove(Handle, body));
            GC.KeepAlive(this);
        }

        public unsafe bool BodyIsValid(Body body) {
            bool answer = Native.hh_body_is_valid(Handle, body) != 0;
            GC.KeepAlive(this);
            return answer;
        }

        public unsafe Body BodyFind(string name) {
            Body body;
            Body body_at;
            fixed (byte* name_at = Library.Text(name)) {
                Library.Check(Native.hh_body_find(Handle, name_at, &body_at));
                body = body_at;
                GC.KeepAlive(this);
            }
            return body;
        }

        /// <summary>Valid until a body is added or removed. Empty if the name came only with a snapshot.</summary>
        public unsafe string BodyName(Body body) {
            string name;
            byte* name_at;
            Library.Check(Native.hh_body_name(Handle, body, &name_at));
            name = Library.Text(name_at);
            GC.KeepAlive(this);
            return name;
        }

        /// <summary>Ids of all bodies; `count` gets their number. HH_ERROR_CAPACITY if it is more than `capacity`. A null buffer of capacity 0: the number only.</summary>
        public unsafe Body[] Bodies() {
            Body[] bodies;
            UIntPtr count_at;
            Library.Check(Native.hh_world_bodies(Handle, null, UIntPtr.Zero, &count_at));
            Body[] made = new Body[(long)count_at];
            fixed (Body* made_at = made) { Library.Check(Native.hh_world_bodies(Handle, made_at, count_at, &count_at)); }
            bodies = made;
            GC.KeepAlive(this);
            return bodies;
        }

        public unsafe HhPose BodyPose(Body body) {
            HhPose pose;
            HhPose pose_at;
            Library.Check(Native.hh_body_pose(Handle, body, &pose_at));
            pose = pose_at;
            GC.KeepAlive(this);
            return pose;
        }

        /// <summary>Poses of many bodies in one call; HH_ERROR_HANDLE, and nothing written, if one is stale.</summary>
        public unsafe HhPose[] BodyPoses(Body[] bodies) {
            HhPose[] poses;
            HhPose[] poses_made = new HhPose[(int)Library.Count(bodies)];
            fixed (Body* bodies_at = bodies) {
                fixed (HhPose* poses_at = poses_made) {
                    Library.Check(Native.hh_world_body_poses(Handle, bodies_at, Library.Count(bodies), poses_at));
                    poses = poses_made;
                    GC.KeepAlive(this);
                }
            }
            return poses;
        }

        /// <summary>Null outputs are skipped.</summary>
        public unsafe void BodyVelocity(Body body, out Vec3 velocity_mps, out Vec3 angular_velocity_radps) {
            Vec3 velocity_mps_at;
            Vec3 angular_velocity_radps_at;
            Library.Check(Native.hh_body_velocity(Handle, body, &velocity_mps_at, &angular_velocity_radps_at));
            velocity_mps = velocity_mps_at;
            angular_velocity_radps = angular_velocity_radps_at;
            GC.KeepAlive(this);
        }

        /// <summary>Within 1e6 m/s and 1e4 rad/s. HH_ERROR_STATE for a body that is not dynamic.</summary>
        public unsafe void BodySetVelocity(Body body, Vec3 velocity_mps, Vec3 angular_velocity_radps) {
            Library.Check(Native.hh_body_set_velocity(Handle, body, velocity_mps, angular_velocity_radps));
            GC.KeepAlive(this);
        }

        /// <summary>Changes the velocity by an impulse in N s at a point in the world. HH_ERROR_STATE for a body that is not dynamic, HH_ERROR_VALUE if the velocity would leave the limits of hh_body_set_velocity.</summary>
        public unsafe void BodyApplyImpulse(Body body, Vec3 impulse_ns, Vec3 point) {
            Library.Check(Native.hh_body_apply_impulse(Handle, body, impulse_ns, point));
            GC.KeepAlive(this);
        }

        /// <summary>Moves a body at once, without collisions on the path. It keeps its velocity; hands that grip it let go.</summary>
        public unsafe void BodyTeleport(Body body, HhPose pose) {
            Library.Check(Native.hh_body_teleport(Handle, body, pose));
            GC.KeepAlive(this);
        }

        /// <summary>A kinematic body reaches the pose at the end of the next step and then rests. Call it before every step in which it moves, or less often: a host that ticks slower than it draws may tell each tick's pose once. The body's velocity, with which hands leave it and bodies are thrown, is the displacement since the pose before over the time since then; over tracking.release_window_s if the poses come at varying times. It is 0 once a pose is due that does not come or is the same. The first pose after a rest counts as half a second's motion, since nothing says when it began.</summary>
        public unsafe void BodyMoveKinematic(Body body, HhPose pose) {
            Library.Check(Native.hh_body_move_kinematic(Handle, body, pose));
            GC.KeepAlive(this);
        }

        public unsafe void BodySetGravityScale(Body body, double scale) {
            Library.Check(Native.hh_body_set_gravity_scale(Handle, body, scale));
            GC.KeepAlive(this);
        }

        public unsafe void BodySetLayers(Body body, uint layers, uint mask) {
            Library.Check(Native.hh_body_set_layers(Handle, body, layers, mask));
            GC.KeepAlive(this);
        }

        public unsafe void BodySetGrabRule(Body body, bool left, bool right, bool two_hands, int priority) {
            Library.Check(Native.hh_body_set_grab_rule(Handle, body, (byte)(left ? 1 : 0), (byte)(right ? 1 : 0), (byte)(two_hands ? 1 : 0), priority));
            GC.KeepAlive(this);
        }

        public unsafe BodyKind BodyGetKind(Body body) {
            BodyKind kind;
            BodyKind kind_at;
            Library.Check(Native.hh_body_get_kind(Handle, body, &kind_at));
            kind = kind_at;
            GC.KeepAlive(this);
            return kind;
        }

        /// <summary>0 for a body that is not dynamic: nothing that acts on it moves it.</summary>
        public unsafe double BodyMass(Body body) {
            double mass_kg;
            double mass_kg_at;
            Library.Check(Native.hh_body_mass(Handle, body, &mass_kg_at));
            mass_kg = mass_kg_at;
            GC.KeepAlive(this);
            return mass_kg;
        }

        /// <summary>Mass in [1e-12, 1e15] kg and inertia as hh_body_def's, else HH_ERROR_VALUE; 0 inertia: of the solid shape. Dynamic bodies only: HH_ERROR_STATE. Hands keep their grips: beyond phases.heavy_body_kg the body moves its player from the next step on, below it comes along.</summary>
        public unsafe void BodySetMass(Body body, double mass_kg, Vec3 inertia_kgm2) {
            Library.Check(Native.hh_body_set_mass(Handle, body, mass_kg, inertia_kgm2));
            GC.KeepAlive(this);
        }

        /// <summary>Friction in [0, 1e6], restitution in [0, 1]. Null outputs are skipped.</summary>
        public unsafe void BodyMaterial(Body body, out double friction, out double restitution) {
            double friction_at;
            double restitution_at;
            Library.Check(Native.hh_body_material(Handle, body, &friction_at, &restitution_at));
            friction = friction_at;
            restitution = restitution_at;
            GC.KeepAlive(this);
        }

        public unsafe void BodySetMaterial(Body body, double friction, double restitution) {
            Library.Check(Native.hh_body_set_material(Handle, body, friction, restitution));
            GC.KeepAlive(this);
        }

        /// <summary>A body becomes static, kinematic or dynamic where it is. Hands keep their grips without a jump: a body that becomes dynamic comes along, others move the player. A body that becomes static or kinematic stops; one that becomes dynamic keeps its velocity. Joints stay. Mass and inertia: of a body that becomes dynamic, as hh_body_set_mass; of others ignored. A mesh cannot become dynamic: HH_ERROR_VALUE. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step.</summary>
        public unsafe void BodySetKind(Body body, BodyKind kind, double mass_kg, Vec3 inertia_kgm2) {
            Library.Check(Native.hh_body_set_kind(Handle, body, kind, mass_kg, inertia_kgm2));
            GC.KeepAlive(this);
        }

        /// <summary>Null for a body without a shape.</summary>
        public unsafe Shape BodyShape(Body body) {
            Shape shape;
            Shape shape_at;
            Library.Check(Native.hh_body_shape(Handle, body, &shape_at));
            shape = shape_at;
            GC.KeepAlive(this);
            return shape;
        }

        /// <summary>The body touches with another shape from now on, or with none (null id). A dynamic body needs a solid shape: HH_ERROR_VALUE for none or a mesh. The body's pose, joints and grips stay as they are in the frame in which the host made the shapes, whatever their centres of mass; a dynamic body's inertia becomes that of the solid shape with the same mass. Hands let go in the next step (HH_EVENT_RELEASED, HH_REASON_BY_HOST) if the body has no shape any more, or if their palm is farther from the new surface than a closing hand reaches: hand.ray_length_m minus hand.ray_back_m, or hand.reach_m if that is larger. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; with a mesh that a hand grips, linear in its triangles, 0.1 ms for 5,000.</summary>
        public unsafe void BodySetShape(Body body, Shape shape) {
            Library.Check(Native.hh_body_set_shape(Handle, body, shape));
            GC.KeepAlive(this);
        }

        public unsafe void BodySetUserData(Body body, ulong user_data) {
            Library.Check(Native.hh_body_set_user_data(Handle, body, user_data));
            GC.KeepAlive(this);
        }

        public unsafe ulong BodyUserData(Body body) {
            ulong user_data;
            ulong user_data_at;
            Library.Check(Native.hh_body_user_data(Handle, body, &user_data_at));
            user_data = user_data_at;
            GC.KeepAlive(this);
            return user_data;
        }

        /// <summary>Adds a level from the bytes of a glTF file (.glb, or .gltf with its data inside): a static body with a mesh for each node that has triangles, where the file has them, moved by `pose`. Its name is the node's, with a number if the world has that name. `bodies` may be null; `count` gets their number. HH_ERROR_CAPACITY and HH_ERROR_DATA, which says what the file lacks: nothing is added. Cost: that of hh_mesh_create for every triangle.</summary>
        public unsafe Body[] AddGltfLevel(byte[] gltf, HhPose pose) {
            Body[] bodies;
            UIntPtr count_at;
            fixed (byte* gltf_at = gltf) {
                Library.Check(Native.hh_world_add_gltf_level(Handle, gltf_at, Library.Count(gltf), pose, null, UIntPtr.Zero, &count_at));
                Body[] made = new Body[(long)count_at];
                fixed (Body* made_at = made) { Library.Check(Native.hh_world_add_gltf_level(Handle, gltf_at, Library.Count(gltf), pose, made_at, count_at, &count_at)); }
                bodies = made;
                GC.KeepAlive(this);
            }
            return bodies;
        }

        public unsafe HhJoint JointAdd(JointDef? def, string name = null) {
            HhJoint joint;
            JointDef def_at = def.GetValueOrDefault();
            HhJoint joint_at;
            fixed (byte* name_at = Library.Text(name)) {
                if (name != null) def_at.name = name_at;
                Library.Check(Native.hh_joint_add(Handle, def.HasValue ? &def_at : null, &joint_at));
                joint = joint_at;
                GC.KeepAlive(this);
            }
            return joint;
        }

        public unsafe void JointRemove(HhJoint joint) {
            Library.Check(Native.hh_joint_remove(Handle, joint));
            GC.KeepAlive(this);
        }

        public unsafe bool JointIsValid(HhJoint joint) {
            bool answer = Native.hh_joint_is_valid(Handle, joint) != 0;
            GC.KeepAlive(this);
            return answer;
        }

        /// <summary>Ids of the joints of a body; `count` gets their number. HH_ERROR_CAPACITY if it is more than `capacity`. A null buffer of capacity 0: the number only.</summary>
        public unsafe HhJoint[] BodyJoints(Body body) {
            HhJoint[] joints;
            UIntPtr count_at;
            Library.Check(Native.hh_body_joints(Handle, body, null, UIntPtr.Zero, &count_at));
            HhJoint[] made = new HhJoint[(long)count_at];
            fixed (HhJoint* made_at = made) { Library.Check(Native.hh_body_joints(Handle, body, made_at, count_at, &count_at)); }
            joints = made;
            GC.KeepAlive(this);
            return joints;
        }

        /// <summary>Drives a hinge or slider from the next step on, with a limited force, as friction acts; replaces its detents. A position's target moves a stiff drive: a load below the strength does not deflect it. Part of the state. HH_ERROR_VALUE for other kinds of joints. Cost: that of a joint with friction.</summary>
        public unsafe void JointSetMotor(HhJoint joint, MotorDef? def) {
            MotorDef def_at = def.GetValueOrDefault();
            Library.Check(Native.hh_joint_set_motor(Handle, joint, def.HasValue ? &def_at : null));
            GC.KeepAlive(this);
        }

        /// <summary>New limits of the coordinate, as in hh_joint_def; equal ones lock the joint there. A joint beyond them is moved within. Bodies move at once: hands that held on may slip.</summary>
        public unsafe void JointSetLimits(HhJoint joint, bool limited, double lower, double upper) {
            Library.Check(Native.hh_joint_set_limits(Handle, joint, (byte)(limited ? 1 : 0), lower, upper));
            GC.KeepAlive(this);
        }

        /// <summary>A new latch, as in hh_joint_def; range 0: none. The handle stays. A closed latch stays closed if it is at the same place.</summary>
        public unsafe void JointSetLatch(HhJoint joint, double at, double range, double strength) {
            Library.Check(Native.hh_joint_set_latch(Handle, joint, at, range, strength));
            GC.KeepAlive(this);
        }

        public unsafe void JointSetFriction(HhJoint joint, double friction) {
            Library.Check(Native.hh_joint_set_friction(Handle, joint, friction));
            GC.KeepAlive(this);
        }

        /// <summary>State after the last step; null outputs are skipped. A hinge counts full turns.</summary>
        public unsafe void JointState(HhJoint joint, out double coordinate, out double speed, out bool latched) {
            double coordinate_at;
            double speed_at;
            byte latched_at;
            Library.Check(Native.hh_joint_state(Handle, joint, &coordinate_at, &speed_at, &latched_at));
            coordinate = coordinate_at;
            speed = speed_at;
            latched = latched_at != 0;
            GC.KeepAlive(this);
        }

        /// <summary>The contacts of the last step, in a fixed order: pairs that have come within 0.1 mm, or between which an impulse acted. Empty after a restore and after hh_world_step_simulated. `count` gets their number; HH_ERROR_CAPACITY if it is more than `capacity`.</summary>
        public unsafe Contact[] Contacts() {
            Contact[] contacts;
            UIntPtr count_at;
            Library.Check(Native.hh_world_contacts(Handle, null, UIntPtr.Zero, &count_at));
            Contact[] made = new Contact[(long)count_at];
            fixed (Contact* made_at = made) { Library.Check(Native.hh_world_contacts(Handle, made_at, count_at, &count_at)); }
            contacts = made;
            GC.KeepAlive(this);
            return contacts;
        }

        /// <summary>First surface that the segment hits, from outside or inside; distance_m: from `from`. `skip`: a player whose head counts as not there; null: none. Coordinates within 1e9 m.</summary>
        public unsafe Hit CastRay(Vec3 from, Vec3 to, Player skip) {
            Hit hit;
            Hit hit_at;
            Library.Check(Native.hh_world_cast_ray(Handle, from, to, skip, &hit_at));
            hit = hit_at;
            GC.KeepAlive(this);
            return hit;
        }

        /// <summary>First impact of a sphere that moves along the segment. Radius in [1e-6, 1e4] m; distance_m: how far its centre has moved, 0 if it touches something at the start.</summary>
        public unsafe Hit CastSphere(double radius_m, Vec3 from, Vec3 to, Player skip) {
            Hit hit;
            Hit hit_at;
            Library.Check(Native.hh_world_cast_sphere(Handle, radius_m, from, to, skip, &hit_at));
            hit = hit_at;
            GC.KeepAlive(this);
            return hit;
        }

        /// <summary>Nearest surface point within max_distance_m of the point, [0, 1e4]; distance_m: 0 inside a solid, where the normal points outward.</summary>
        public unsafe Hit ClosestPoint(Vec3 point, double max_distance_m, Player skip) {
            Hit hit;
            Hit hit_at;
            Library.Check(Native.hh_world_closest_point(Handle, point, max_distance_m, skip, &hit_at));
            hit = hit_at;
            GC.KeepAlive(this);
            return hit;
        }

        /// <summary>Everything that a sphere touches: the nearest point of each body and head to its centre, in a fixed order. Inside a solid distance_m is 0 and the normal points outward. `count` gets their number; HH_ERROR_CAPACITY if it is more than `capacity`. Radius in [0, 1e4] m.</summary>
        public unsafe Hit[] OverlapSphere(Vec3 center, double radius_m, Player skip) {
            Hit[] hits;
            UIntPtr count_at;
            Library.Check(Native.hh_world_overlap_sphere(Handle, center, radius_m, skip, null, UIntPtr.Zero, &count_at));
            Hit[] made = new Hit[(long)count_at];
            fixed (Hit* made_at = made) { Library.Check(Native.hh_world_overlap_sphere(Handle, center, radius_m, skip, made_at, count_at, &count_at)); }
            hits = made;
            GC.KeepAlive(this);
            return hits;
        }

        public unsafe Player PlayerAdd(PlayerDef? def, string name = null) {
            Player player;
            PlayerDef def_at = def.GetValueOrDefault();
            Player player_at;
            fixed (byte* name_at = Library.Text(name)) {
                if (name != null) def_at.name = name_at;
                Library.Check(Native.hh_player_add(Handle, def.HasValue ? &def_at : null, &player_at));
                player = player_at;
                GC.KeepAlive(this);
            }
            return player;
        }

        public unsafe void PlayerRemove(Player player) {
            Library.Check(Native.hh_player_remove(Handle, player));
            GC.KeepAlive(this);
        }

        public unsafe bool PlayerIsValid(Player player) {
            bool answer = Native.hh_player_is_valid(Handle, player) != 0;
            GC.KeepAlive(this);
            return answer;
        }

        public unsafe Player[] Players() {
            Player[] players;
            UIntPtr count_at;
            Library.Check(Native.hh_world_players(Handle, null, UIntPtr.Zero, &count_at));
            Player[] made = new Player[(long)count_at];
            fixed (Player* made_at = made) { Library.Check(Native.hh_world_players(Handle, made_at, count_at, &count_at)); }
            players = made;
            GC.KeepAlive(this);
            return players;
        }

        /// <summary>The headset's runtime, or the host, has recentred: from the next sample on, poses are given in a space that lies at `new_in_old` in the space before (OpenXR: poseInPreviousSpace). It turns about +Y only, else HH_ERROR_VALUE: x and z of the quaternion within 0.001. Before the player's first sample there is nothing to recentre. View, hands and grips stay where they are in the world; hh_player_pose.origin changes at once, HH_EVENT_RECENTRED follows in the next step. From now on the host announces all recentrings, as after hh_player_set_recenter_guess(world, player, 0).</summary>
        public unsafe void PlayerRecenter(Player player, HhPose new_in_old) {
            Library.Check(Native.hh_player_recenter(Handle, player, new_in_old));
            GC.KeepAlive(this);
        }

        /// <summary>`guesses` 1, the default: if head and hands jump by one turn about +Y and one translation, or the head by more than tracking.max_jump_m, the runtime has recentred, and nothing in the world moves. 0: the host announces recentrings, and every other jump is meant, such as a turn that the host puts into its samples: view and hands follow it, and gripping hands take new anchors. Part of the state.</summary>
        public unsafe void PlayerSetRecenterGuess(Player player, bool guesses) {
            Library.Check(Native.hh_player_set_recenter_guess(Handle, player, (byte)(guesses ? 1 : 0)));
            GC.KeepAlive(this);
        }

        /// <summary>Moves the play space at once; it is then at rest relative to the scene. Dynamic bodies in the hands that no joint holds come along; hands let go of everything else, and hands of other players let go of this player and of those bodies.</summary>
        public unsafe void PlayerTeleport(Player player, HhPose origin) {
            Library.Check(Native.hh_player_teleport(Handle, player, origin));
            GC.KeepAlive(this);
        }

        public unsafe Vec3 PlayerVelocity(Player player) {
            Vec3 velocity_mps;
            Vec3 velocity_mps_at;
            Library.Check(Native.hh_player_velocity(Handle, player, &velocity_mps_at));
            velocity_mps = velocity_mps_at;
            GC.KeepAlive(this);
            return velocity_mps;
        }

        public unsafe void PlayerSetVelocity(Player player, Vec3 velocity_mps) {
            Library.Check(Native.hh_player_set_velocity(Handle, player, velocity_mps));
            GC.KeepAlive(this);
        }

        /// <summary>The velocity that counts as rest for the player: that of the body last gripped, at the gripped point, else the scene's. A player feels the speed relative to it: for vignettes and wind.</summary>
        public unsafe Vec3 PlayerReferenceVelocity(Player player) {
            Vec3 velocity_mps;
            Vec3 velocity_mps_at;
            Library.Check(Native.hh_player_reference_velocity(Handle, player, &velocity_mps_at));
            velocity_mps = velocity_mps_at;
            GC.KeepAlive(this);
            return velocity_mps;
        }

        /// <summary>How far contacts moved the play space in the last step, against its hands and its velocity.</summary>
        public unsafe double PlayerPushBack(Player player) {
            double distance_m;
            double distance_m_at;
            Library.Check(Native.hh_player_push_back(Handle, player, &distance_m_at));
            distance_m = distance_m_at;
            GC.KeepAlive(this);
            return distance_m;
        }

        /// <summary>hh_player_def.mass_kg.</summary>
        public unsafe double PlayerMass(Player player) {
            double mass_kg;
            double mass_kg_at;
            Library.Check(Native.hh_player_mass(Handle, player, &mass_kg_at));
            mass_kg = mass_kg_at;
            GC.KeepAlive(this);
            return mass_kg;
        }

        /// <summary>The sphere with which the head collides, in the world. Null outputs are skipped. is_tracked: false before the head's first sample, and while it is lost or inferred.</summary>
        public unsafe void PlayerHead(Player player, out Vec3 center, out double radius_m, out bool is_tracked) {
            Vec3 center_at;
            double radius_m_at;
            byte is_tracked_at;
            Library.Check(Native.hh_player_head(Handle, player, &center_at, &radius_m_at, &is_tracked_at));
            center = center_at;
            radius_m = radius_m_at;
            is_tracked = is_tracked_at != 0;
            GC.KeepAlive(this);
        }

        /// <summary>The measures times the player's scale, in the world's metres: those given or measured in a T-pose, else what is believed of the player's size by now.</summary>
        public unsafe Measures PlayerMeasures(Player player) {
            Measures measures;
            Measures measures_at;
            Library.Check(Native.hh_player_measures(Handle, player, &measures_at));
            measures = measures_at;
            GC.KeepAlive(this);
            return measures;
        }

        /// <summary>Replaces the measures, which are then no longer estimated. `measures`, not null: times the player's scale, each in [0.05, 5] m times the scale.</summary>
        public unsafe void PlayerSetMeasures(Player player, Measures measures) {
            Library.Check(Native.hh_player_set_measures(Handle, player, &measures));
            GC.KeepAlive(this);
        }

        public unsafe void PlayerSetUserData(Player player, ulong user_data) {
            Library.Check(Native.hh_player_set_user_data(Handle, player, user_data));
            GC.KeepAlive(this);
        }

        public unsafe ulong PlayerUserData(Player player) {
            ulong user_data;
            ulong user_data_at;
            Library.Check(Native.hh_player_user_data(Handle, player, &user_data_at));
            user_data = user_data_at;
            GC.KeepAlive(this);
            return user_data;
        }

        /// <summary>Sets the hand's wrist in the frame of hh_tracking_sample.hands: identity if the samples are wrists with OpenXR's axes (-Z to the fingers, +Y the back of the hand). The pose is in the world's metres, like the samples, and does not scale with the player; within 10 m. Null: the default, which is the tuning's hand.controller_ numbers, for a controller's grip pose, times the player's scale.</summary>
        public unsafe void PlayerSetHandInController(Player player, Side side, HhPose? hand_in_controller) {
            HhPose hand_in_controller_at = hand_in_controller.GetValueOrDefault();
            Library.Check(Native.hh_player_set_hand_in_controller(Handle, player, side, hand_in_controller.HasValue ? &hand_in_controller_at : null));
            GC.KeepAlive(this);
        }

        /// <summary>Returns the wrist in the frame of the player's samples, in the world's metres: the pose set by hh_player_set_hand_in_controller or, without one, the tuning's times the player's scale. For hosts that have wrists and need controllers.</summary>
        public unsafe HhPose PlayerHandInController(Player player, Side side) {
            HhPose hand_in_controller;
            HhPose hand_in_controller_at;
            Library.Check(Native.hh_player_hand_in_controller(Handle, player, side, &hand_in_controller_at));
            hand_in_controller = hand_in_controller_at;
            GC.KeepAlive(this);
            return hand_in_controller;
        }

        /// <summary>Returns the tuning's pose of the wrist in a controller. Players of scale 1 without a pose of their own have it.</summary>
        public unsafe HhPose HandInController(Side side) {
            HhPose hand_in_controller;
            HhPose hand_in_controller_at;
            Library.Check(Native.hh_world_hand_in_controller(Handle, side, &hand_in_controller_at));
            hand_in_controller = hand_in_controller_at;
            GC.KeepAlive(this);
            return hand_in_controller;
        }

        /// <summary>One hand. `hand_size`: bytes of hh_hand_state as the host knows it.</summary>
        public unsafe HandState PlayerHand(Player player, Side side) {
            HandState hand;
            HandState hand_at;
            Library.Check(Native.hh_player_hand_sized(Handle, player, side, &hand_at, (UIntPtr)sizeof(HandState)));
            hand = hand_at;
            GC.KeepAlive(this);
            return hand;
        }

        /// <summary>True if the player can pull on what the hand grips: something static, kinematic or heavy, another player, or a body that joints connect to something fixed, such as a lever. False if the hand is empty, or what it holds comes along.</summary>
        public unsafe bool HandMovesPlayer(Player player, Side side) {
            bool moves_player;
            byte moves_player_at;
            Library.Check(Native.hh_hand_moves_player(Handle, player, side, &moves_player_at));
            moves_player = moves_player_at != 0;
            GC.KeepAlive(this);
            return moves_player;
        }

        /// <summary>Poses of many players in one call; HH_ERROR_HANDLE, and nothing written, if one is stale. `pose_size`, `hand_size`: bytes of hh_player_pose and hh_hand_state as the host knows them.</summary>
        public unsafe PlayerPose[] PlayerPoses(Player[] players) {
            PlayerPose[] poses;
            PlayerPose[] poses_made = new PlayerPose[(int)Library.Count(players)];
            fixed (Player* players_at = players) {
                fixed (PlayerPose* poses_at = poses_made) {
                    Library.Check(Native.hh_world_player_poses_sized(Handle, players_at, Library.Count(players), poses_at, (UIntPtr)sizeof(PlayerPose), (UIntPtr)sizeof(HandState)));
                    poses = poses_made;
                    GC.KeepAlive(this);
                }
            }
            return poses;
        }

        /// <summary>In the next step the hand grips `body` where both are, at any distance, whatever the grab rules say; only a body for two hands needs an order for both. No grip begins while the player opens the hand. It holds until hh_hand_release or until the player opens the hand. If the player closes the hand before that, it grips what is in reach instead; with nothing in reach, the grip stays. HH_ERROR_STATE for a hand that was never tracked.</summary>
        public unsafe void HandGrip(Player player, Side side, Body body) {
            Library.Check(Native.hh_hand_grip(Handle, player, side, body));
            GC.KeepAlive(this);
        }

        /// <summary>In the next step the hand lets go, without a throw. It grips again when the player opens and closes it. HH_OK also for an empty hand.</summary>
        public unsafe void HandRelease(Player player, Side side) {
            Library.Check(Native.hh_hand_release(Handle, player, side));
            GC.KeepAlive(this);
        }

        /// <summary>The events of the last step, in a fixed order. Valid until the next step, restore, destroy or call of this function. `event_size`: bytes of hh_event as the host knows it; the list's elements lie so far apart.</summary>
        public unsafe HhEvent[] Events() {
            HhEvent[] events;
            HhEvent* events_at;
            UIntPtr count_at;
            Library.Check(Native.hh_world_events_sized(Handle, &events_at, &count_at, (UIntPtr)sizeof(HhEvent)));
            HhEvent[] made = new HhEvent[(long)count_at];
            for (long i = 0; i < made.LongLength; ++i) made[i] = events_at[i];
            events = made;
            GC.KeepAlive(this);
            return events;
        }

        /// <summary>The shown hand's joints. `joints`: HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name.</summary>
        public unsafe HandJoint[] PlayerHandJoints(Player player, Side side, HhSpace space) {
            HandJoint[] joints;
            HandJoint[] joints_made = new HandJoint[26];
            fixed (HandJoint* joints_at = joints_made) {
                Library.Check(Native.hh_player_hand_joints(Handle, player, side, space, joints_at));
                joints = joints_made;
                GC.KeepAlive(this);
            }
            return joints;
        }

        /// <summary>`joints`: HH_BODY_JOINT_COUNT elements.</summary>
        public unsafe HhPose[] PlayerBodyJoints(Player player, HhSpace space) {
            HhPose[] joints;
            HhPose[] joints_made = new HhPose[20];
            fixed (HhPose* joints_at = joints_made) {
                Library.Check(Native.hh_player_body_joints(Handle, player, space, joints_at));
                joints = joints_made;
                GC.KeepAlive(this);
            }
            return joints;
        }

        /// <summary>The player's hand gets the proportions of the skeleton in a glTF file (.glb, or .gltf with its data inside) whose joints have WebXR's or OpenXR's names. Null bytes: the built-in hand. HH_ERROR_DATA says what the file lacks.</summary>
        public unsafe void PlayerSetHandRig(Player player, Side side, byte[] gltf) {
            fixed (byte* gltf_at = gltf) {
                Library.Check(Native.hh_player_set_hand_rig(Handle, player, side, gltf_at, Library.Count(gltf)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>The player's body drives a humanoid skeleton from a glTF file; the table of a VRM file says which joint is which. Null bytes: none.</summary>
        public unsafe void PlayerSetBodyRig(Player player, byte[] gltf) {
            fixed (byte* gltf_at = gltf) {
                Library.Check(Native.hh_player_set_body_rig(Handle, player, gltf_at, Library.Count(gltf)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>hh_player_set_body_rig for a skeleton as an array, of an engine that has no glTF file: 1 to 1024 joints, in any order. In other axes: handhold/convert.h. No joints: none. The tracked head lies between the eyes: at joints below the head whose names end in "eye", "eyes", "eye_l", "eye_r", "eye.l" or "eye.r", in any case, else estimated from the head's joint and its children. HH_ERROR_VALUE for parents that do not exist or form a ring; HH_ERROR_DATA says by name or index which joints are missing or implausible.</summary>
        public unsafe void PlayerSetBodySkeleton(Player player, SkeletonJoint[] joints, HhSpace space, string[] names = null) {
            SkeletonJoint[] joints_given = Library.Copy(joints);
            byte[] names_bytes = Library.Texts(names, joints, "names");
            fixed (SkeletonJoint* joints_at = joints_given) {
                fixed (byte* names_at = names_bytes) {
                    for (int at = 0, i = 0; names != null && i < names.Length; at += Library.Size(names[i]), ++i) joints_at[i].name = names[i] == null ? null : names_at + at;
                    Library.Check(Native.hh_player_set_body_skeleton(Handle, player, joints_at, Library.Count(joints), space));
                    GC.KeepAlive(this);
                }
            }
        }

        /// <summary>Joints of the player's body rig, in the order in which they were given. Fingers follow the shown hand's; a figure with both hands' fingers needs no second pair of hands (hh_player_skeleton_fingers). HH_ERROR_STATE without a rig.</summary>
        public unsafe HhPose[] PlayerSkeleton(Player player, HhSpace space) {
            HhPose[] joints;
            UIntPtr count_at;
            Library.Check(Native.hh_player_skeleton(Handle, player, space, null, UIntPtr.Zero, &count_at));
            HhPose[] made = new HhPose[(long)count_at];
            fixed (HhPose* made_at = made) { Library.Check(Native.hh_player_skeleton(Handle, player, space, made_at, count_at, &count_at)); }
            joints = made;
            GC.KeepAlive(this);
            return joints;
        }

        /// <summary>Name and parent (-1: none) of one of these joints. The name is valid while the rig is set.</summary>
        public unsafe void PlayerSkeletonJoint(Player player, long joint, out string name, out int parent) {
            byte* name_at;
            int parent_at;
            Library.Check(Native.hh_player_skeleton_joint(Handle, player, (UIntPtr)(ulong)joint, &name_at, &parent_at));
            name = Library.Text(name_at);
            parent = parent_at;
            GC.KeepAlive(this);
        }

        /// <summary>Number of fingers of a hand of the body rig that follow the shown hand's, 0 to 5: 0 is a figure whose hands the host draws by hh_player_hand_joints.</summary>
        public unsafe long PlayerSkeletonFingers(Player player, Side side) {
            long count;
            UIntPtr count_at;
            Library.Check(Native.hh_player_skeleton_fingers(Handle, player, side, &count_at));
            count = (long)count_at;
            GC.KeepAlive(this);
            return count;
        }

        /// <summary>Adds an authored grip to a body: hands that close near it take it. HH_ERROR_STATE if the body has 4 already.</summary>
        public unsafe void BodyAddGrip(Body body, GripDef? def) {
            GripDef def_at = def.GetValueOrDefault();
            Library.Check(Native.hh_body_add_grip(Handle, body, def.HasValue ? &def_at : null));
            GC.KeepAlive(this);
        }

        /// <summary>The triangles that palm and fingers close on, in the body's frame; null: none. Not needed for gripping. The body must have no shape. HH_ERROR_STATE if it has, or if the mesh or the world was made without fits_hands.</summary>
        public unsafe void BodySetSurface(Body body, HhMesh mesh) {
            Library.Check(Native.hh_body_set_surface(Handle, body, mesh == null ? IntPtr.Zero : mesh.Handle));
            GC.KeepAlive(mesh);
            GC.KeepAlive(this);
        }

        /// <summary>Where bodies are now, after the host's own step. Unlike a teleport it ends no grip. A kinematic body rests there until hh_body_move_kinematic says where it will be at the end of the next step. Places all or, on an error, none. HH_ERROR_VALUE for a body that is there twice.</summary>
        public unsafe void PlaceBodies(BodyMotion[] motions) {
            fixed (BodyMotion* motions_at = motions) {
                Library.Check(Native.hh_world_place_bodies(Handle, motions_at, Library.Count(motions)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>Where a player's hh_player_pose.origin is now, and its velocity, by the host's locomotion. Unlike a teleport it ends no grip.</summary>
        public unsafe void PlayerPlace(Player player, HhPose origin, Vec3 velocity_mps) {
            Library.Check(Native.hh_player_place(Handle, player, origin, velocity_mps));
            GC.KeepAlive(this);
        }

        /// <summary>The hand holds `body` from now on; a null id: nothing. `anchor`: the wrist in the body's frame; null: where both are now, HH_ERROR_STATE for a hand that was never tracked. For hosts that use hh_world_step_hands only: the other steps keep the hold and let the hand pull the player.</summary>
        public unsafe void HandHold(Player player, Side side, Body body, HhPose? anchor) {
            HhPose anchor_at = anchor.GetValueOrDefault();
            Library.Check(Native.hh_hand_hold(Handle, player, side, body, anchor.HasValue ? &anchor_at : null));
            GC.KeepAlive(this);
        }

        /// <summary>What the hand would grip if it closed where it is, by the rules of hands that pull players: reach, sight, grab rules, authored grips. A null body: nothing, or another player. distance_m: from the palm. In every kind of world. HH_ERROR_STATE for a hand that was never tracked.</summary>
        public unsafe SurfaceHit HandFindGrip(Player player, Side side) {
            SurfaceHit hit;
            SurfaceHit hit_at;
            Library.Check(Native.hh_hand_find_grip(Handle, player, side, &hit_at));
            hit = hit_at;
            GC.KeepAlive(this);
            return hit;
        }

        /// <summary>One frame: reads tracking and shows hands and bodies where the host put them. It moves neither players nor bodies, and buttons do nothing: place bodies by hh_world_place_bodies. A move ordered by hh_body_move_kinematic waits for the next step of another kind. Cost: that of hh_world_step without physics.</summary>
        public unsafe void StepHands(double dt_s, PlayerInput[] inputs) {
            fixed (PlayerInput* inputs_at = inputs) {
                Library.Check(Native.hh_world_step_hands(Handle, dt_s, inputs_at, Library.Count(inputs)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>First half of a step: tracking, grips and constraints. Bodies must be placed where they are. Until hh_world_end_step, HH_ERROR_STATE for adding or removing bodies, joints and players, for teleporting, saving and other steps; hh_world_restore forgets the begun step.</summary>
        public unsafe void BeginStep(double dt_s, PlayerInput[] inputs) {
            fixed (PlayerInput* inputs_at = inputs) {
                Library.Check(Native.hh_world_begin_step(Handle, dt_s, inputs_at, Library.Count(inputs)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>Constraints of the begun step: at most one per hand, in the order in which hands were added. Valid until hh_world_end_step.</summary>
        public unsafe HandConstraint[] HandConstraints() {
            HandConstraint[] constraints;
            HandConstraint* constraints_at;
            UIntPtr count_at;
            Library.Check(Native.hh_world_hand_constraints(Handle, &constraints_at, &count_at));
            HandConstraint[] made = new HandConstraint[(long)count_at];
            for (long i = 0; i < made.LongLength; ++i) made[i] = constraints_at[i];
            constraints = made;
            GC.KeepAlive(this);
            return constraints;
        }

        /// <summary>One entry per player, in the order of hh_world_players. Valid until hh_world_end_step.</summary>
        public unsafe PlayerMotion[] PlayerMotions() {
            PlayerMotion[] motions;
            PlayerMotion* motions_at;
            UIntPtr count_at;
            Library.Check(Native.hh_world_player_motions(Handle, &motions_at, &count_at));
            PlayerMotion[] made = new PlayerMotion[(long)count_at];
            for (long i = 0; i < made.LongLength; ++i) made[i] = motions_at[i];
            motions = made;
            GC.KeepAlive(this);
            return motions;
        }

        /// <summary>Second half, after the host's solver. `players`: the solved play spaces; one left out moves as predicted, HH_ERROR_VALUE for one that is there twice. Bodies that the host has not placed since hh_world_begin_step rest where they were. Releases grips, limits velocities and shows hands and bodies. On an error the step stays begun.</summary>
        public unsafe void EndStep(SolvedPlayer[] players) {
            fixed (SolvedPlayer* players_at = players) {
                Library.Check(Native.hh_world_end_step(Handle, players_at, Library.Count(players)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>Velocities that the host must give its bodies: after hh_world_begin_step those of bodies that the distance grab pulls, after hh_world_end_step those of thrown and limited bodies. Players': hh_player_velocity. Valid until the next step.</summary>
        public unsafe VelocityChange[] VelocityChanges() {
            VelocityChange[] changes;
            VelocityChange* changes_at;
            UIntPtr count_at;
            Library.Check(Native.hh_world_velocity_changes(Handle, &changes_at, &count_at));
            VelocityChange[] made = new VelocityChange[(long)count_at];
            for (long i = 0; i < made.LongLength; ++i) made[i] = changes_at[i];
            changes = made;
            GC.KeepAlive(this);
            return changes;
        }

        /// <summary>After hh_world_step: dynamic bodies that hands hold, and those that joints connect to them. The host makes its own kinematic, takes pose and velocity from here, and places all others before the next step. They touch nothing of the host's, but push what its solver pushes.</summary>
        public unsafe Body[] HeldBodies() {
            Body[] bodies;
            UIntPtr count_at;
            Library.Check(Native.hh_world_held_bodies(Handle, null, UIntPtr.Zero, &count_at));
            Body[] made = new Body[(long)count_at];
            fixed (Body* made_at = made) { Library.Check(Native.hh_world_held_bodies(Handle, made_at, count_at, &count_at)); }
            bodies = made;
            GC.KeepAlive(this);
            return bodies;
        }
    }

    public partial class Match {

        /// <summary>How often to call hh_match_advance for so much time of the local clock since the last call, [0, 8]: a little more or less than its share, so that inputs reach the server just before they are needed. A spectator stays 9 ticks behind what has come.</summary>
        public unsafe uint TicksDue(double elapsed_s) {
            uint ticks;
            uint ticks_at;
            Library.Check(Native.hh_match_ticks_due(Handle, elapsed_s, &ticks_at));
            ticks = ticks_at;
            GC.KeepAlive(this);
            return ticks;
        }

        /// <summary>Goes back to the first wrong guess, if there is one, steps again to the present, and then one tick on. `input`, not null. `advanced` gets false, and the input is dropped, while the world is 62 ticks ahead of the last confirmed tick. Each tick stepped again costs about a quarter of a shown step: docs/reference/matches.md has figures. A spectator steps the next confirmed tick, or gets false if its inputs have not come; of `input` it takes only is_hidden.</summary>
        public unsafe bool Advance(MatchInput input) {
            bool advanced;
            byte advanced_at;
            Library.Check(Native.hh_match_advance(Handle, &input, &advanced_at));
            advanced = advanced_at != 0;
            GC.KeepAlive(this);
            return advanced;
        }

        /// <summary>Takes a packet of the server; a spectator those of hh_match_confirmed_inputs. HH_ERROR_DATA, and no change, for bytes that are damaged or not of this match. Packets that came too late or out of order are HH_OK: what they lack comes again. Both are counted in hh_match_stats.refused. Tolerates any bytes.</summary>
        public unsafe void Receive(byte[] packet) {
            fixed (byte* packet_at = packet) {
                Library.Check(Native.hh_match_receive(Handle, packet_at, Library.Count(packet)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>Clients only. Writes the next packet to the server, `size` bytes. Call once a tick or once in two. A null `buffer` asks for the most bytes that a packet has, HH_MATCH_PACKET_BYTES; HH_ERROR_CAPACITY for a smaller `capacity`.</summary>
        public unsafe byte[] Packet() {
            byte[] buffer;
            UIntPtr size_at;
            Library.Check(Native.hh_match_packet(Handle, null, UIntPtr.Zero, &size_at));
            byte[] made = new byte[(long)size_at];
            fixed (byte* made_at = made) { Library.Check(Native.hh_match_packet(Handle, made_at, size_at, &size_at)); }
            Array.Resize(ref made, (int)size_at);
            buffer = made;
            GC.KeepAlive(this);
            return buffer;
        }

        /// <summary>Replaces the world's state by the one of hh_match_state, over a reliable stream of yours. Set your own state to the server's of the same tick before the next hh_match_advance. HH_ERROR_DATA, and no change, for other bytes. Tolerates any bytes.</summary>
        public unsafe void Join(byte[] bytes) {
            fixed (byte* bytes_at = bytes) {
                Library.Check(Native.hh_match_join(Handle, bytes_at, Library.Count(bytes)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>Somebody plays the slot, or nobody does: then its hands let go and its body floats. At first nobody plays any slot.</summary>
        public unsafe void Connect(uint slot) {
            Library.Check(Native.hh_match_connect(Handle, slot));
            GC.KeepAlive(this);
        }

        public unsafe void Disconnect(uint slot) {
            Library.Check(Native.hh_match_disconnect(Handle, slot));
            GC.KeepAlive(this);
        }

        /// <summary>Takes a packet that came from that slot's player, at `now_s` on the server's clock. As hh_match_receive; a packet of another slot is HH_ERROR_DATA. The checksum in it finds damage, not forgery: your transport authenticates.</summary>
        public unsafe void ReceiveFrom(uint slot, double now_s, byte[] packet) {
            fixed (byte* packet_at = packet) {
                Library.Check(Native.hh_match_receive_from(Handle, slot, now_s, packet_at, Library.Count(packet)));
                GC.KeepAlive(this);
            }
        }

        /// <summary>Confirms and steps the ticks whose inputs are complete, or which have ended on the server's clock; missing inputs are filled by a guess that all machines share. At most 16 a call; `ticks` gets the number. Call several times a tick. Null output: skipped.</summary>
        public unsafe uint Confirm(double now_s) {
            uint ticks;
            uint ticks_at;
            Library.Check(Native.hh_match_confirm(Handle, now_s, &ticks_at));
            ticks = ticks_at;
            GC.KeepAlive(this);
            return ticks;
        }

        /// <summary>Writes the next packet to that slot's player. As hh_match_packet.</summary>
        public unsafe byte[] PacketTo(uint slot) {
            byte[] buffer;
            UIntPtr size_at;
            Library.Check(Native.hh_match_packet_to(Handle, slot, null, UIntPtr.Zero, &size_at));
            byte[] made = new byte[(long)size_at];
            fixed (byte* made_at = made) { Library.Check(Native.hh_match_packet_to(Handle, slot, made_at, size_at, &size_at)); }
            Array.Resize(ref made, (int)size_at);
            buffer = made;
            GC.KeepAlive(this);
            return buffer;
        }

        /// <summary>Writes the state that a player joins with, `size` bytes, for hh_match_join; send your own state of this tick with it. From now on the player is sent the inputs after it. As hh_world_save; with a null `buffer` nothing changes. HH_MATCH_NO_SLOT: the state for a spectator, who is sent the confirmed inputs after the present tick.</summary>
        public unsafe byte[] State(uint slot) {
            byte[] buffer;
            UIntPtr size_at;
            Library.Check(Native.hh_match_state(Handle, slot, null, UIntPtr.Zero, &size_at));
            byte[] made = new byte[(long)size_at];
            fixed (byte* made_at = made) { Library.Check(Native.hh_match_state(Handle, slot, made_at, size_at, &size_at)); }
            Array.Resize(ref made, (int)size_at);
            buffer = made;
            GC.KeepAlive(this);
            return buffer;
        }

        /// <summary>Steps one tick with an input for each slot, then goes back sync_ticks and steps again.</summary>
        public unsafe MatchDifference SyncTest(MatchInput[] inputs) {
            MatchDifference difference;
            MatchDifference difference_at;
            fixed (MatchInput* inputs_at = inputs) {
                Library.Check(Native.hh_match_sync_test(Handle, inputs_at, Library.Count(inputs), &difference_at));
                difference = difference_at;
                GC.KeepAlive(this);
            }
            return difference;
        }

        /// <summary>Writes the inputs of all slots in the confirmed ticks after `after`, for hh_match_receive of spectators: over a reliable stream of yours, or into a file, which then has the whole match. `until` gets the last tick written, `after` if there is nothing new: 128 ticks at most, and fewer if the buffer is full. Every 90th tick carries its hash, which the reader compares. HH_ERROR_VALUE if `after` is later than the last confirmed tick, or too early: 320 ticks are always kept, at most 448. A spectator then needs a state. A null `buffer` asks for HH_MATCH_INPUTS_BYTES; HH_ERROR_CAPACITY for less.</summary>
        public unsafe void ConfirmedInputs(ulong after, out byte[] buffer, out ulong until) {
            UIntPtr size_at;
            ulong until_at;
            Library.Check(Native.hh_match_confirmed_inputs(Handle, after, null, UIntPtr.Zero, &size_at, &until_at));
            byte[] made = new byte[(long)size_at];
            fixed (byte* made_at = made) { Library.Check(Native.hh_match_confirmed_inputs(Handle, after, made_at, size_at, &size_at, &until_at)); }
            Array.Resize(ref made, (int)size_at);
            buffer = made;
            until = until_at;
            GC.KeepAlive(this);
        }

        /// <summary>A player needs hh_match_state and hh_match_join: the world differs from the server's, or inputs are lost for good. A client answers for its own slot only, a spectator for any.</summary>
        public unsafe bool NeedsState(uint slot) {
            bool needs;
            byte needs_at;
            Library.Check(Native.hh_match_needs_state(Handle, slot, &needs_at));
            needs = needs_at != 0;
            GC.KeepAlive(this);
            return needs;
        }

        /// <summary>Hash of world and game after a tick: equal on all machines if the tick is confirmed. HH_ERROR_VALUE unless it is the present one or, on a client, one of the 63 before that it has stepped.</summary>
        public unsafe ulong Hash(ulong tick) {
            ulong hash;
            ulong hash_at;
            Library.Check(Native.hh_match_hash(Handle, tick, &hash_at));
            hash = hash_at;
            GC.KeepAlive(this);
            return hash;
        }

        /// <summary>Add these to the drawn positions of a slot's player, so that a corrected guess moves them within 0.08 s and not at once: to head and body, and to each hand with what it holds. m, world axes. For the own slot `head` is for the view too, with hands that hold nothing: it moves when others pull at what you hold. Only for pictures. Zero for servers, spectators and sync tests.</summary>
        public unsafe void ShownOffsets(uint slot, out Vec3 head, out Vec3 left, out Vec3 right) {
            Vec3 head_at;
            Vec3 left_at;
            Vec3 right_at;
            Library.Check(Native.hh_match_shown_offsets(Handle, slot, &head_at, &left_at, &right_at));
            head = head_at;
            left = left_at;
            right = right_at;
            GC.KeepAlive(this);
        }

        /// <summary>Where to draw a slot's player between two ticks, for displays of another rate than the tick's: at the time up to which hh_match_ticks_due has been called, less one tick, which lies between the last two shown ticks. Call after the ticks of a picture. With hh_match_shown_offsets already. World poses: `origin` is the space of the samples, for the camera rig; `head`; and wrists to draw. A play space that moves by more than 0.5 m or turns by more than 0.2 rad at once, as by a teleport or a snap turn, is not drawn in between. While the world waits, everything stands still. `newest`, for the own slot: the devices at the time of the picture, of any time_s. Head and empty hands are then drawn where they are, and not late. Null: between ticks, as everything else. Fingers go with their wrist; arms, spine and legs with the head. Never changes the world. HH_ERROR_VALUE if `newest` is given for another slot, or to a spectator. Clients and spectators. HH_ERROR_STATE before the first shown tick, and after hh_match_join.</summary>
        public unsafe void DrawnPlayer(uint slot, TrackingSample? newest, out HhPose origin, out HhPose head, out HhPose left, out HhPose right) {
            TrackingSample newest_at = newest.GetValueOrDefault();
            HhPose origin_at;
            HhPose head_at;
            HhPose left_at;
            HhPose right_at;
            Library.Check(Native.hh_match_drawn_player(Handle, slot, newest.HasValue ? &newest_at : null, &origin_at, &head_at, &left_at, &right_at));
            origin = origin_at;
            head = head_at;
            left = left_at;
            right = right_at;
            GC.KeepAlive(this);
        }

        /// <summary>The same for bodies: poses as of hh_world_body_poses. A body that is held goes with its hands; one that moves by more than 0.5 m at once is not drawn in between.</summary>
        public unsafe HhPose[] DrawnBodies(Body[] bodies) {
            HhPose[] poses;
            HhPose[] poses_made = new HhPose[(int)Library.Count(bodies)];
            fixed (Body* bodies_at = bodies) {
                fixed (HhPose* poses_at = poses_made) {
                    Library.Check(Native.hh_match_drawn_bodies(Handle, bodies_at, Library.Count(bodies), poses_at));
                    poses = poses_made;
                    GC.KeepAlive(this);
                }
            }
            return poses;
        }

        /// <summary>What the last hh_match_advance, hh_match_confirm, hh_match_join or hh_match_sync_test found, in the order of finding. Servers and sync tests have confirmed events only. Valid until the next call of these or of this function. `event_size`: bytes of hh_match_event as the host knows it; the list's elements lie so far apart.</summary>
        public unsafe MatchEvent[] Events() {
            MatchEvent[] events;
            MatchEvent* events_at;
            UIntPtr count_at;
            Library.Check(Native.hh_match_events_sized(Handle, &events_at, &count_at, (UIntPtr)sizeof(MatchEvent)));
            MatchEvent[] made = new MatchEvent[(long)count_at];
            for (long i = 0; i < made.LongLength; ++i) made[i] = events_at[i];
            events = made;
            GC.KeepAlive(this);
            return events;
        }

        public unsafe MatchStats GetStats() {
            MatchStats stats;
            MatchStats stats_at = MatchStats.Default();
            Library.Check(Native.hh_match_get_stats(Handle, &stats_at));
            stats = stats_at;
            GC.KeepAlive(this);
            return stats;
        }
    }
}
