"""The C interface's structs, enums and functions. Made by systems/host/bindings/generate.py; do not edit."""
import enum
from ctypes import (CFUNCTYPE, POINTER, byref, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p,
                    sizeof)

from ._library import Struct, array, changed, check, copied, empty, fixed, handle, held, lib, listed, optional, raw, shown, text, value

# Structs whose functions the library may call.
_kept = {}

HANDHOLD_VERSION_MAJOR = 0
HANDHOLD_VERSION_MINOR = 2
HANDHOLD_VERSION_PATCH = 0
HANDHOLD_VERSION_TEXT = '0.2.0'
HH_HAND_JOINT_COUNT = 26
HH_IS_BY_NAME = 0
HH_IS_BODY = 100
HH_IS_LEFT_HAND = 200
HH_IS_RIGHT_HAND = 300
HH_MATCH_PLAYERS = 16
HH_MATCH_PACKET_BYTES = 1200
HH_MATCH_INPUTS_BYTES = 8192
HH_MATCH_NO_SLOT = 4294967295
HH_MATCH_PLACES = 64
HH_MATCH_REFUSALS = 16


class Result(enum.IntEnum):
    """hh_result"""
    HH_OK = 0
    HH_ERROR_NULL = 1  # a pointer that is needed is null
    HH_ERROR_VERSION = 2  # a size of a struct is not of a version that the library knows
    HH_ERROR_HANDLE = 3  # an id is null, stale or of another world
    HH_ERROR_VALUE = 4  # a number is NaN or out of range, or a combination makes no sense
    HH_ERROR_NAME = 5  # a name is taken, or nothing has it
    HH_ERROR_STATE = 6  # not possible now, for instance a shape in use
    HH_ERROR_CAPACITY = 7  # the buffer is too small; the count says how much is needed
    HH_ERROR_DATA = 8  # bytes that cannot be read: a snapshot, a glTF file, JSON
    HH_ERROR_MEMORY = 9  # no memory left
    HH_ERROR_INTERNAL = 10  # a defect of the library; hh_host_hooks.assert_failed was called


class Side(enum.IntEnum):
    """hh_side"""
    HH_LEFT = 0
    HH_RIGHT = 1


class LogLevel(enum.IntEnum):
    """hh_log_level"""
    HH_LOG_NOTE = 0
    HH_LOG_ERROR = 1


class Engine(enum.IntEnum):
    """hh_engine"""
    HH_ENGINE_UNITY = 0  # left-handed, +X right, +Y up, +Z ahead, metres
    HH_ENGINE_UNREAL = 1  # left-handed, +X ahead, +Y right, +Z up, centimetres
    HH_ENGINE_GODOT = 2  # as Handhold: right-handed, +X right, +Y up, -Z ahead, metres


class MomentumReceiver(enum.IntEnum):
    """What receives the impulses of constraints, index of hh_momentum's arrays."""
    HH_MOMENTUM_BODIES = 0  # dynamic bodies
    HH_MOMENTUM_PLAYERS = 1
    HH_MOMENTUM_DISCARDED = 2  # impulses of hands on bodies that did not push the player back
    HH_MOMENTUM_STATICS = 3  # static and kinematic bodies
    HH_MOMENTUM_RECEIVERS = 4


class BodyKind(enum.IntEnum):
    """hh_body_kind"""
    HH_STATIC = 0  # never moves, except by hh_body_teleport
    HH_KINEMATIC = 1  # moved by hh_body_move_kinematic; pushes others and carries hands
    HH_DYNAMIC = 2  # moved by its velocity, contacts, joints and hands


class JointKind(enum.IntEnum):
    """Each kind has a coordinate, on which limits, friction, detents and latches act."""
    HH_BALL = 0  # points coincide; coordinate: angle between the axes, rad; limits: a cone
    HH_HINGE = 1  # turns about the axis; coordinate: angle, rad
    HH_SLIDER = 2  # moves along the axis; coordinate: displacement, m
    HH_FIXED = 3  # no coordinate
    HH_DISTANCE = 4  # coordinate: distance of two points, m; lower 0: a rope; equal limits: a rod


class MotorKind(enum.IntEnum):
    """hh_motor_kind"""
    HH_MOTOR_NONE = 0
    HH_MOTOR_SPEED = 1  # towards a speed of the coordinate
    HH_MOTOR_POSITION = 2  # towards a coordinate


class GripKind(enum.IntEnum):
    """hh_grip_kind"""
    HH_GRIP_NONE = 0
    HH_GRIP_SURFACE = 1  # something static, kinematic or heavy: the player moves
    HH_GRIP_HELD = 2  # a dynamic body: it moves with the hand
    HH_GRIP_AUTHORED = 3  # in one of the body's authored grips
    HH_GRIP_PLAYER = 4  # another player: head, arm, trunk or leg


class EventKind(enum.IntEnum):
    """hh_event_kind"""
    HH_EVENT_TOUCHED = 0  # The palm of an empty, tracked hand came within 2 cm times the player's scale of a body or of another player's head.
    HH_EVENT_GRABBED = 1  # a hand grips
    HH_EVENT_RELEASED = 2  # the player opened the hand, or `reason` says who did
    HH_EVENT_REFUSED = 3  # a hand closed and grips nothing: `reason`
    HH_EVENT_SLIPPED = 4  # a hand lost its grip: `reason`
    HH_EVENT_CONTACT_BEGAN = 5  # The player's head, or what a hand holds, hits a body or another player's head.
    HH_EVENT_CONTACT_ENDED = 6
    HH_EVENT_LATCH_CLOSED = 7  # of `joint`
    HH_EVENT_LATCH_OPENED = 8
    HH_EVENT_LIMIT_REACHED = 9  # a joint came to its lower or upper limit
    HH_EVENT_RECENTRED = 10  # hh_player_pose.origin was changed so that a recentring moves nothing. HH_REASON_BY_HOST: by hh_player_recenter; HH_REASON_NONE: the samples jumped. `position`: the head.


class Reason(enum.IntEnum):
    """hh_reason"""
    HH_REASON_NONE = 0
    HH_REASON_OPENED = 1  # the player opened the hand
    HH_REASON_NO_SURFACE = 2  # nothing in reach, or only behind a wall
    HH_REASON_NOT_ALLOWED = 3  # a grab rule or layers refuse the hand
    HH_REASON_NEEDS_TWO_HANDS = 4  # the other hand is not there, or left
    HH_REASON_STRETCHED = 5  # farther from its anchor than hand.max_stretch_m
    HH_REASON_TRACKING_LOST = 6  # it opened unseen, or came back too far away
    HH_REASON_BODY_GONE = 7  # the body was removed
    HH_REASON_BY_HOST = 8  # hh_hand_release, hh_hand_grip, hh_hand_hold, hh_body_set_shape or a teleport
    HH_REASON_OTHER_HAND = 9  # the other of two hands on a body let go


class Space(enum.IntEnum):
    """hh_space"""
    HH_SPACE_WORLD = 0
    HH_SPACE_PARENT = 1  # in the parent joint's frame; roots: in the world


class HandJointName(enum.IntEnum):
    """Joints as XR_EXT_hand_tracking has them, in its order and with its axes. The parent of palm and
    metacarpals is the wrist."""
    HH_HAND_PALM = 0
    HH_HAND_WRIST = 1
    HH_THUMB_METACARPAL = 2
    HH_THUMB_PROXIMAL = 3
    HH_THUMB_DISTAL = 4
    HH_THUMB_TIP = 5
    HH_INDEX_METACARPAL = 6
    HH_INDEX_PROXIMAL = 7
    HH_INDEX_INTERMEDIATE = 8
    HH_INDEX_DISTAL = 9
    HH_INDEX_TIP = 10
    HH_MIDDLE_METACARPAL = 11
    HH_MIDDLE_PROXIMAL = 12
    HH_MIDDLE_INTERMEDIATE = 13
    HH_MIDDLE_DISTAL = 14
    HH_MIDDLE_TIP = 15
    HH_RING_METACARPAL = 16
    HH_RING_PROXIMAL = 17
    HH_RING_INTERMEDIATE = 18
    HH_RING_DISTAL = 19
    HH_RING_TIP = 20
    HH_LITTLE_METACARPAL = 21
    HH_LITTLE_PROXIMAL = 22
    HH_LITTLE_INTERMEDIATE = 23
    HH_LITTLE_DISTAL = 24
    HH_LITTLE_TIP = 25


class BodyJoint(enum.IntEnum):
    """Joints of a humanoid, with VRM's names. Trunk, head and legs: +Y up along the bone, -Z to the front. Arms:
    -Z along the bone, +Y on the elbow's side. Hands: the wrist's axes."""
    HH_HIPS = 0
    HH_SPINE = 1
    HH_CHEST = 2
    HH_UPPER_CHEST = 3
    HH_NECK = 4
    HH_HEAD = 5
    HH_LEFT_SHOULDER = 6
    HH_LEFT_UPPER_ARM = 7
    HH_LEFT_LOWER_ARM = 8
    HH_LEFT_HAND = 9
    HH_RIGHT_SHOULDER = 10
    HH_RIGHT_UPPER_ARM = 11
    HH_RIGHT_LOWER_ARM = 12
    HH_RIGHT_HAND = 13
    HH_LEFT_UPPER_LEG = 14
    HH_LEFT_LOWER_LEG = 15
    HH_LEFT_FOOT = 16
    HH_RIGHT_UPPER_LEG = 17
    HH_RIGHT_LOWER_LEG = 18
    HH_RIGHT_FOOT = 19
    HH_BODY_JOINT_COUNT = 20


class HandRows(enum.IntEnum):
    """What a hand asks of the host's solver. The player is a body of the host's: a point mass at the play
    space's origin that cannot turn: at hh_player_pose.origin until a recentring, which does not move it. At
    the end of the step, with origin and body solved: POINT origin + target.position = body * anchor.position
    WELD the same, and the body's rotation is body_rotation DIRECTION the body's rotation is body_rotation:
    the second of two hands on one body"""
    HH_ROWS_POINT = 0
    HH_ROWS_WELD = 1
    HH_ROWS_DIRECTION = 2


class MatchRole(enum.IntEnum):
    """hh_match_role"""
    HH_MATCH_CLIENT = 0
    HH_MATCH_SERVER = 1
    HH_MATCH_SYNC_TEST = 2  # No network: every tick is stepped again from `sync_ticks` before, and must give the same hashes. Finds state that your game forgets to restore.
    HH_MATCH_SPECTATOR = 3  # Nobody's machine: steps confirmed ticks only, from hh_match_confirmed_inputs. For those who watch, and for recordings of matches. Has no slot and sends no packets.


class MatchEventState(enum.IntEnum):
    """hh_match_event_state"""
    HH_MATCH_PREDICTED = 0  # It happened in a tick that may change. Each such event is confirmed or retracted later.
    HH_MATCH_CONFIRMED = 1  # its tick is final. Each event of a confirmed tick comes so once
    HH_MATCH_RETRACTED = 2  # a predicted event that did not happen


class MatchRefusal(enum.IntEnum):
    """Why a packet was refused: index of hh_match_stats.refused."""
    HH_MATCH_REFUSED_SIZE = 1  # shorter than any packet, or longer
    HH_MATCH_REFUSED_CHECKSUM = 2  # damaged
    HH_MATCH_REFUSED_VERSION = 3  # of another version of the format, or another kind
    HH_MATCH_REFUSED_SENDER = 4  # another slot's, or of one that is not connected
    HH_MATCH_REFUSED_MALFORMED = 5  # fields out of range
    HH_MATCH_REFUSED_GAP = 6  # inputs before it have not arrived. Usual with losses
    HH_MATCH_REFUSED_WINDOW = 7  # too old or too far ahead. Usual around joins
    HH_MATCH_REFUSED_STATE = 8  # a state that hh_match_join could not restore


HH_OK = Result.HH_OK
HH_ERROR_NULL = Result.HH_ERROR_NULL
HH_ERROR_VERSION = Result.HH_ERROR_VERSION
HH_ERROR_HANDLE = Result.HH_ERROR_HANDLE
HH_ERROR_VALUE = Result.HH_ERROR_VALUE
HH_ERROR_NAME = Result.HH_ERROR_NAME
HH_ERROR_STATE = Result.HH_ERROR_STATE
HH_ERROR_CAPACITY = Result.HH_ERROR_CAPACITY
HH_ERROR_DATA = Result.HH_ERROR_DATA
HH_ERROR_MEMORY = Result.HH_ERROR_MEMORY
HH_ERROR_INTERNAL = Result.HH_ERROR_INTERNAL
HH_LEFT = Side.HH_LEFT
HH_RIGHT = Side.HH_RIGHT
HH_LOG_NOTE = LogLevel.HH_LOG_NOTE
HH_LOG_ERROR = LogLevel.HH_LOG_ERROR
HH_ENGINE_UNITY = Engine.HH_ENGINE_UNITY
HH_ENGINE_UNREAL = Engine.HH_ENGINE_UNREAL
HH_ENGINE_GODOT = Engine.HH_ENGINE_GODOT
HH_MOMENTUM_BODIES = MomentumReceiver.HH_MOMENTUM_BODIES
HH_MOMENTUM_PLAYERS = MomentumReceiver.HH_MOMENTUM_PLAYERS
HH_MOMENTUM_DISCARDED = MomentumReceiver.HH_MOMENTUM_DISCARDED
HH_MOMENTUM_STATICS = MomentumReceiver.HH_MOMENTUM_STATICS
HH_MOMENTUM_RECEIVERS = MomentumReceiver.HH_MOMENTUM_RECEIVERS
HH_STATIC = BodyKind.HH_STATIC
HH_KINEMATIC = BodyKind.HH_KINEMATIC
HH_DYNAMIC = BodyKind.HH_DYNAMIC
HH_BALL = JointKind.HH_BALL
HH_HINGE = JointKind.HH_HINGE
HH_SLIDER = JointKind.HH_SLIDER
HH_FIXED = JointKind.HH_FIXED
HH_DISTANCE = JointKind.HH_DISTANCE
HH_MOTOR_NONE = MotorKind.HH_MOTOR_NONE
HH_MOTOR_SPEED = MotorKind.HH_MOTOR_SPEED
HH_MOTOR_POSITION = MotorKind.HH_MOTOR_POSITION
HH_GRIP_NONE = GripKind.HH_GRIP_NONE
HH_GRIP_SURFACE = GripKind.HH_GRIP_SURFACE
HH_GRIP_HELD = GripKind.HH_GRIP_HELD
HH_GRIP_AUTHORED = GripKind.HH_GRIP_AUTHORED
HH_GRIP_PLAYER = GripKind.HH_GRIP_PLAYER
HH_EVENT_TOUCHED = EventKind.HH_EVENT_TOUCHED
HH_EVENT_GRABBED = EventKind.HH_EVENT_GRABBED
HH_EVENT_RELEASED = EventKind.HH_EVENT_RELEASED
HH_EVENT_REFUSED = EventKind.HH_EVENT_REFUSED
HH_EVENT_SLIPPED = EventKind.HH_EVENT_SLIPPED
HH_EVENT_CONTACT_BEGAN = EventKind.HH_EVENT_CONTACT_BEGAN
HH_EVENT_CONTACT_ENDED = EventKind.HH_EVENT_CONTACT_ENDED
HH_EVENT_LATCH_CLOSED = EventKind.HH_EVENT_LATCH_CLOSED
HH_EVENT_LATCH_OPENED = EventKind.HH_EVENT_LATCH_OPENED
HH_EVENT_LIMIT_REACHED = EventKind.HH_EVENT_LIMIT_REACHED
HH_EVENT_RECENTRED = EventKind.HH_EVENT_RECENTRED
HH_REASON_NONE = Reason.HH_REASON_NONE
HH_REASON_OPENED = Reason.HH_REASON_OPENED
HH_REASON_NO_SURFACE = Reason.HH_REASON_NO_SURFACE
HH_REASON_NOT_ALLOWED = Reason.HH_REASON_NOT_ALLOWED
HH_REASON_NEEDS_TWO_HANDS = Reason.HH_REASON_NEEDS_TWO_HANDS
HH_REASON_STRETCHED = Reason.HH_REASON_STRETCHED
HH_REASON_TRACKING_LOST = Reason.HH_REASON_TRACKING_LOST
HH_REASON_BODY_GONE = Reason.HH_REASON_BODY_GONE
HH_REASON_BY_HOST = Reason.HH_REASON_BY_HOST
HH_REASON_OTHER_HAND = Reason.HH_REASON_OTHER_HAND
HH_SPACE_WORLD = Space.HH_SPACE_WORLD
HH_SPACE_PARENT = Space.HH_SPACE_PARENT
HH_HAND_PALM = HandJointName.HH_HAND_PALM
HH_HAND_WRIST = HandJointName.HH_HAND_WRIST
HH_THUMB_METACARPAL = HandJointName.HH_THUMB_METACARPAL
HH_THUMB_PROXIMAL = HandJointName.HH_THUMB_PROXIMAL
HH_THUMB_DISTAL = HandJointName.HH_THUMB_DISTAL
HH_THUMB_TIP = HandJointName.HH_THUMB_TIP
HH_INDEX_METACARPAL = HandJointName.HH_INDEX_METACARPAL
HH_INDEX_PROXIMAL = HandJointName.HH_INDEX_PROXIMAL
HH_INDEX_INTERMEDIATE = HandJointName.HH_INDEX_INTERMEDIATE
HH_INDEX_DISTAL = HandJointName.HH_INDEX_DISTAL
HH_INDEX_TIP = HandJointName.HH_INDEX_TIP
HH_MIDDLE_METACARPAL = HandJointName.HH_MIDDLE_METACARPAL
HH_MIDDLE_PROXIMAL = HandJointName.HH_MIDDLE_PROXIMAL
HH_MIDDLE_INTERMEDIATE = HandJointName.HH_MIDDLE_INTERMEDIATE
HH_MIDDLE_DISTAL = HandJointName.HH_MIDDLE_DISTAL
HH_MIDDLE_TIP = HandJointName.HH_MIDDLE_TIP
HH_RING_METACARPAL = HandJointName.HH_RING_METACARPAL
HH_RING_PROXIMAL = HandJointName.HH_RING_PROXIMAL
HH_RING_INTERMEDIATE = HandJointName.HH_RING_INTERMEDIATE
HH_RING_DISTAL = HandJointName.HH_RING_DISTAL
HH_RING_TIP = HandJointName.HH_RING_TIP
HH_LITTLE_METACARPAL = HandJointName.HH_LITTLE_METACARPAL
HH_LITTLE_PROXIMAL = HandJointName.HH_LITTLE_PROXIMAL
HH_LITTLE_INTERMEDIATE = HandJointName.HH_LITTLE_INTERMEDIATE
HH_LITTLE_DISTAL = HandJointName.HH_LITTLE_DISTAL
HH_LITTLE_TIP = HandJointName.HH_LITTLE_TIP
HH_HIPS = BodyJoint.HH_HIPS
HH_SPINE = BodyJoint.HH_SPINE
HH_CHEST = BodyJoint.HH_CHEST
HH_UPPER_CHEST = BodyJoint.HH_UPPER_CHEST
HH_NECK = BodyJoint.HH_NECK
HH_HEAD = BodyJoint.HH_HEAD
HH_LEFT_SHOULDER = BodyJoint.HH_LEFT_SHOULDER
HH_LEFT_UPPER_ARM = BodyJoint.HH_LEFT_UPPER_ARM
HH_LEFT_LOWER_ARM = BodyJoint.HH_LEFT_LOWER_ARM
HH_LEFT_HAND = BodyJoint.HH_LEFT_HAND
HH_RIGHT_SHOULDER = BodyJoint.HH_RIGHT_SHOULDER
HH_RIGHT_UPPER_ARM = BodyJoint.HH_RIGHT_UPPER_ARM
HH_RIGHT_LOWER_ARM = BodyJoint.HH_RIGHT_LOWER_ARM
HH_RIGHT_HAND = BodyJoint.HH_RIGHT_HAND
HH_LEFT_UPPER_LEG = BodyJoint.HH_LEFT_UPPER_LEG
HH_LEFT_LOWER_LEG = BodyJoint.HH_LEFT_LOWER_LEG
HH_LEFT_FOOT = BodyJoint.HH_LEFT_FOOT
HH_RIGHT_UPPER_LEG = BodyJoint.HH_RIGHT_UPPER_LEG
HH_RIGHT_LOWER_LEG = BodyJoint.HH_RIGHT_LOWER_LEG
HH_RIGHT_FOOT = BodyJoint.HH_RIGHT_FOOT
HH_BODY_JOINT_COUNT = BodyJoint.HH_BODY_JOINT_COUNT
HH_ROWS_POINT = HandRows.HH_ROWS_POINT
HH_ROWS_WELD = HandRows.HH_ROWS_WELD
HH_ROWS_DIRECTION = HandRows.HH_ROWS_DIRECTION
HH_MATCH_CLIENT = MatchRole.HH_MATCH_CLIENT
HH_MATCH_SERVER = MatchRole.HH_MATCH_SERVER
HH_MATCH_SYNC_TEST = MatchRole.HH_MATCH_SYNC_TEST
HH_MATCH_SPECTATOR = MatchRole.HH_MATCH_SPECTATOR
HH_MATCH_PREDICTED = MatchEventState.HH_MATCH_PREDICTED
HH_MATCH_CONFIRMED = MatchEventState.HH_MATCH_CONFIRMED
HH_MATCH_RETRACTED = MatchEventState.HH_MATCH_RETRACTED
HH_MATCH_REFUSED_SIZE = MatchRefusal.HH_MATCH_REFUSED_SIZE
HH_MATCH_REFUSED_CHECKSUM = MatchRefusal.HH_MATCH_REFUSED_CHECKSUM
HH_MATCH_REFUSED_VERSION = MatchRefusal.HH_MATCH_REFUSED_VERSION
HH_MATCH_REFUSED_SENDER = MatchRefusal.HH_MATCH_REFUSED_SENDER
HH_MATCH_REFUSED_MALFORMED = MatchRefusal.HH_MATCH_REFUSED_MALFORMED
HH_MATCH_REFUSED_GAP = MatchRefusal.HH_MATCH_REFUSED_GAP
HH_MATCH_REFUSED_WINDOW = MatchRefusal.HH_MATCH_REFUSED_WINDOW
HH_MATCH_REFUSED_STATE = MatchRefusal.HH_MATCH_REFUSED_STATE

Task = CFUNCTYPE(None, c_void_p, c_size_t)


class Vec3(Struct):
    """hh_vec3"""
    _fields_ = [
        ("x", c_double),
        ("y", c_double),
        ("z", c_double),
    ]


class Quat(Struct):
    """hh_quat"""
    _fields_ = [
        ("x", c_double),
        ("y", c_double),
        ("z", c_double),
        ("w", c_double),
    ]


class Pose(Struct):
    """A rigid transform: rotates, then translates. Inputs need a unit rotation within 0.001.
    position: metres"""
    _fields_ = [
        ("position", Vec3),
        ("rotation", Quat),
    ]


class FingerCurls(Struct):
    """How far each finger is bent: thumb, index, middle, ring, little. 0: straight; 1: as in a fist; above 1: as
    1; below 0 or NaN: unknown."""
    _fields_ = [
        ("fingers", c_double * 5),
    ]


class Shape(Struct):
    """Ids: plain values. All zero is null. An id whose object was removed finds nothing, even if its index is
    used again. Ids of two worlds must not be mixed; that is not always detected."""
    _fields_ = [
        ("index", c_uint32),
        ("generation", c_uint32),
    ]


class Body(Struct):
    """hh_body"""
    _fields_ = [
        ("index", c_uint32),
        ("generation", c_uint32),
    ]


class Joint(Struct):
    """hh_joint"""
    _fields_ = [
        ("index", c_uint32),
        ("generation", c_uint32),
    ]


class Player(Struct):
    """hh_player"""
    _fields_ = [
        ("index", c_uint32),
        ("generation", c_uint32),
    ]
HostHooksLog = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)
HostHooksAssertFailed = CFUNCTYPE(None, c_void_p, c_char_p)
HostHooksParallelFor = CFUNCTYPE(None, c_void_p, c_size_t, Task, c_void_p)


class HostHooks(Struct):
    """Functions of the host that the library uses. Null functions are not called; without parallel_for the
    library has its own threads. Memory comes from the global operator new, which a program may replace as
    usual; the shared library and the standard library inside it then use the replacement too, once per
    process. Apart from that a world's blocks are taken and given back by the threads that call it, and by
    those of parallel_for: a replacement with an arena a thread gives each world its own. A host that uses
    Bullet needs its double-precision build, and sets btAlignedAllocSetCustom before the first world.
    context: passed to each of the functions
    log: Called by any thread that calls the library. `message` is one line, valid during the call.
    assert_failed: A defect of the library was found; the call then returns HH_ERROR_INTERNAL.
    parallel_for: Calls task(task_context, i) once for every i in [0, count), on any threads, and returns when
    all are done. Indices should start in ascending order.
    thread_count: Without parallel_for: threads of the library's own pool, the caller's included. [1, 256];
    default 1. Results do not depend on it."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("context", c_void_p),
        ("log", HostHooksLog),
        ("assert_failed", HostHooksAssertFailed),
        ("parallel_for", HostHooksParallelFor),
        ("thread_count", c_uint32),
    ]
    _default_ = "hh_default_host_hooks_sized"


class WorldDef(Struct):
    """hh_world_def
    fits_hands: Fingers and palms close on what they grip. Default true. Without it no shape needs a grip
    mesh, hands are shown as tracked, and meshes are added faster: for servers.
    reports_touches: HH_EVENT_TOUCHED is reported: one query a step for each empty hand. Default true.
    gravity_mps2: of dynamic bodies; default 0. Each axis within 1e4
    reference_velocity_mps: of the scene: what counts as rest. Each axis within 1e6"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("fits_hands", c_uint8),
        ("reports_touches", c_uint8),
        ("gravity_mps2", Vec3),
        ("reference_velocity_mps", Vec3),
    ]
    _default_ = "hh_default_world_def_sized"


class TrackingSample(Struct):
    """One reading of the headset and both controllers. A pose at exactly (0, 0, 0) counts as not tracked, since
    runtimes report devices that sleep so.
    time_s: On the world's clock: hh_world_time plus the step for a sample at the step's end. A sample that is
    not later than the one before is ignored and counted as sample_out_of_order. More than 0.5 s after the
    step's end, it is dropped and counted as sample_too_far_ahead, unless hh_player_input.repeats_samples;
    more than 0.5 s before the step's start, it is counted as sample_too_old. If all samples of a player in a
    step are so far off, the log is told, once per world, that they are on another clock.
    hh_world_step_pose_only takes any times.
    head: between the eyes, in play space: the frame that the tracking is given in
    hands: controllers, by hh_side; see hh_player_set_hand_in_controller
    head_tracked: false: `head` is ignored
    hand_tracked: false: the pose is ignored, `grab` counts
    grab: a button that closes the hand is down
    squeeze: how far it is pressed, [0, 1]: bends fingers until `grab` closes them
    trigger: How far the index finger's trigger is pressed, [0, 1]: bends the index finger of an empty hand,
    and the fingers of authored grips that follow the trigger.
    head_inferred: True if the runtime only guesses the head's position: OpenXR's POSITION_VALID without
    POSITION_TRACKED, WebXR's emulatedPosition, a low confidence. Default false; true overrides head_tracked.
    The head follows the guess, but while a hand grips what the player can pull on, only its rotation does.
    hand_inferred: The same for the hands; true overrides hand_tracked. An inferred hand does not begin to
    grip, and never moves a player who grips: it stays where it was last measured. Opening `grab` lets go,
    without a throw. The shown empty hand follows the guess. When the hand is measured again, its displacement
    since does not count as travel.
    curls: Bend of the fingers of an empty hand; known curls override squeeze and trigger. Default unknown.
    Measured by gloves, or made from joints by hh_finger_curls_of."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("time_s", c_double),
        ("head", Pose),
        ("hands", Pose * 2),
        ("head_tracked", c_uint8),
        ("hand_tracked", c_uint8 * 2),
        ("grab", c_uint8 * 2),
        ("squeeze", c_double * 2),
        ("trigger", c_double * 2),
        ("head_inferred", c_uint8),
        ("hand_inferred", c_uint8 * 2),
        ("curls", FingerCurls * 2),
    ]
    _default_ = "hh_default_tracking_sample_sized"


class Commands(Struct):
    """What a player asks for in one step. All zero: nothing. Grows with hh_player_input, of which it is the last
    field. In the fields of later versions, too, 0 will ask for nothing.
    smooth_turn: [-1, 1], positive turns left
    snap_turns: turns to the left begun in this step; negative: to the right
    brake: [0, 1]
    thrust: play space, each in [-1, 1]; needs locomotion.thruster_mps2 above 0
    calibrate: held while the player holds a T-pose: measures the body"""
    _fields_ = [
        ("smooth_turn", c_double),
        ("snap_turns", c_int32),
        ("brake", c_double),
        ("thrust", Vec3),
        ("calibrate", c_uint8),
    ]


class PlayerInput(Struct):
    """One player's input of one step. Fill by hh_default_player_input.
    samples: The samples since the last step, sorted by time. Give each once. Up to 64 may be later than this
    step's end, by at most 0.5 s, as predicted poses are: the poses at the end are then interpolated, and each
    sample is kept for the step of its time, even if that step has no input. A new sample replaces kept
    samples of the same time or later. None: the devices are silent, except for kept samples.
    repeats_samples: True: the host gives a sample that is later than the step's end again in the next step,
    so the world keeps none, and sample times are exact. False, the default: up to a microsecond after the
    step's end counts as the end. For hosts that have the whole stream: recordings, rollback."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("player", Player),
        ("samples", POINTER(TrackingSample)),
        ("sample_count", c_size_t),
        ("repeats_samples", c_uint8),
        ("commands", Commands),
    ]
    _default_ = "hh_default_player_input_sized"
    _arrays_ = {'samples': ('sample_count', 1)}


class Momentum(Struct):
    """Sums of all impulses of a step, by hh_momentum_receiver. Each array's sum is 0.
    angular_kgm2ps: about the world's origin"""
    _fields_ = [
        ("linear_kgmps", Vec3 * 4),
        ("angular_kgm2ps", Vec3 * 4),
    ]


class WorldStats(Struct):
    """Numbers of the last step.
    shapes: now
    islands: groups of bodies that constraints connect
    newton_iterations: of all solves
    hand_error_m: largest distance of a gripping hand from its anchor
    overlap_m: worst contact overlap at the end
    joint_error_m: largest position error of a joint
    step_us: sum of all stages
    joint_error_rad: largest error of a joint's direction, or angle beyond a limit
    islands_pushed: islands in which something pushed a player back
    contact_rounds: searches for contacts inside the solve
    hands_closed: hands that closed
    hands_gripped: grips that began
    deepest_a: The two of `overlap_m`; null: a player's head, or no overlap.
    deepest_b: The two of `overlap_m`; null: a player's head, or no overlap."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("bodies", c_uint64),
        ("joints", c_uint64),
        ("players", c_uint64),
        ("shapes", c_uint64),
        ("contacts", c_uint64),
        ("islands", c_uint64),
        ("newton_iterations", c_uint64),
        ("hand_error_m", c_double),
        ("overlap_m", c_double),
        ("joint_error_m", c_double),
        ("step_us", c_double),
        ("joint_error_rad", c_double),
        ("islands_pushed", c_uint64),
        ("contact_rounds", c_uint64),
        ("hands_closed", c_uint64),
        ("hands_gripped", c_uint64),
        ("momentum", Momentum),
        ("deepest_a", Body),
        ("deepest_b", Body),
    ]
    _default_ = "hh_default_world_stats_sized"


class TuningInfo(Struct):
    """A tunable number, or a vector of three. Texts live as long as the process.
    name: "hand.reach_m"
    unit: "m", ""
    high: of each component
    count: 1 or 3
    scales: true: each player has the number times hh_player_def.scale"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("unit", c_char_p),
        ("what", c_char_p),
        ("low", c_double),
        ("high", c_double),
        ("count", c_size_t),
        ("scales", c_uint8),
    ]
    _default_ = "hh_default_tuning_info_sized"


class CompoundPart(Struct):
    """A part of a compound: any shape but a mesh or a compound.
    pose: in the compound's frame
    mass_kg: give it for all parts, or 0 for all: the mass is then spread by volume"""
    _fields_ = [
        ("shape", Shape),
        ("pose", Pose),
        ("mass_kg", c_double),
    ]


class MeshDef(Struct):
    """hh_mesh_def
    positions: x, y, z of each vertex, metres
    vertex_stride: bytes from one vertex to the next; 0: 12
    index_count: a multiple of 3, at most 3 * 2^21
    fits_hands: default true; false: hands on it are shown as tracked"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("positions", POINTER(c_float)),
        ("vertex_count", c_size_t),
        ("vertex_stride", c_size_t),
        ("indices", POINTER(c_uint32)),
        ("index_count", c_size_t),
        ("fits_hands", c_uint8),
    ]
    _default_ = "hh_default_mesh_def_sized"
    _arrays_ = {'positions': ('vertex_count', 3), 'indices': ('index_count', 1)}


class BodyDef(Struct):
    """A body's pose is that of its shape's own frame, as the host made it: the library finds centre of mass and
    principal axes by itself. Velocities are those of the centre of mass, in the world.
    name: unique in the world, identifies the body in hashes; null: by its id
    shape: null: touches nothing
    velocity_mps: each within 1e6
    angular_velocity_radps: each within 1e4
    mass_kg: dynamic: [1e-12, 1e15], default 1
    inertia_kgm2: About the principal axes; 0: computed from the shape. A dynamic body without a shape needs
    one: HH_ERROR_VALUE.
    restitution: [0, 1]
    friction: [0, 1e6], default 0.4
    gravity_scale: default 1; within 1000
    mask: two bodies touch if each one's layers meet the other's mask
    grab_right: which hands may grip it; default both
    grab_two_hands: only both hands of one player at once
    grab_priority: of bodies in reach, hands take one of highest priority; default 0
    user_data: the host's; not part of the state"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("kind", c_int32),
        ("shape", Shape),
        ("pose", Pose),
        ("velocity_mps", Vec3),
        ("angular_velocity_radps", Vec3),
        ("mass_kg", c_double),
        ("inertia_kgm2", Vec3),
        ("restitution", c_double),
        ("friction", c_double),
        ("gravity_scale", c_double),
        ("layers", c_uint32),
        ("mask", c_uint32),
        ("grab_left", c_uint8),
        ("grab_right", c_uint8),
        ("grab_two_hands", c_uint8),
        ("grab_priority", c_int32),
        ("user_data", c_uint64),
    ]
    _default_ = "hh_default_body_def_sized"


class JointDef(Struct):
    """hh_joint_def
    name: unique in the world; null: by its id
    body_a: null: the world
    frame: in the world, with the bodies where they are now: x is the joint's axis
    point_b: HH_DISTANCE: the point on body_b, in the world; the point on body_a is frame's.
    collides: the two bodies touch each other; default false
    limited: lower and upper apply; distance joints are always limited
    friction: N, or N m about a hinge or any axis of a ball; >= 0
    detent_spacing: a rest position at each multiple; 0: none
    detent_strength: force towards the nearest rest position, N or N m
    latch_at: the latch locks the coordinate at this
    latch_range: the latch closes within this distance; 0: no latch
    latch_strength: the latch opens above this force, N or N m; 0: never by force
    latch_handle: a joint that opens it; null: none
    latch_handle_at: open while |handle's coordinate| is at least this"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("kind", c_int32),
        ("body_a", Body),
        ("body_b", Body),
        ("frame", Pose),
        ("point_b", Vec3),
        ("collides", c_uint8),
        ("limited", c_uint8),
        ("lower", c_double),
        ("upper", c_double),
        ("friction", c_double),
        ("detent_spacing", c_double),
        ("detent_strength", c_double),
        ("latch_at", c_double),
        ("latch_range", c_double),
        ("latch_strength", c_double),
        ("latch_handle", Joint),
        ("latch_handle_at", c_double),
    ]
    _default_ = "hh_default_joint_def_sized"


class MotorDef(Struct):
    """hh_motor_def
    kind: default HH_MOTOR_NONE
    speed: HH_MOTOR_SPEED: rad/s or m/s, within 1e9
    position: HH_MOTOR_POSITION: rad or m, within 1e9; a hinge counts full turns
    time_s: HH_MOTOR_POSITION: the joint moves so fast that it would be there after this; a step at least, 1e9
    at most, s; default 0.1
    strength: largest force, N or N m, [0, 1e15]; default 0"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("speed", c_double),
        ("position", c_double),
        ("time_s", c_double),
        ("strength", c_double),
    ]
    _default_ = "hh_default_motor_def_sized"


class Contact(Struct):
    """Two surfaces that touched in the last step. Whichever of body and player is not null it is: a player's
    head, or a body.
    point: on the surface of a, in the world
    normal: unit, from b to a
    depth_m: how deep they overlap; negative: apart
    impulse_ns: that the step applied, >= 0"""
    _fields_ = [
        ("body_a", Body),
        ("body_b", Body),
        ("player_a", Player),
        ("player_b", Player),
        ("point", Vec3),
        ("normal", Vec3),
        ("depth_m", c_double),
        ("impulse_ns", c_double),
    ]


class Hit(Struct):
    """Queries test the shapes of all bodies, whatever their layers, and the tracked heads of players, at their
    present poses. Bodies without a shape, and surfaces of hh_world_set_surface_query, are not found.
    HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; the first query
    after a change of the world also compares every body with its place before.
    body: null: a player's head, or nothing was found
    player: whose head; null: a body, or nothing was found
    point: on the surface, in the world
    normal: unit, to the side that the query came from
    distance_m: see each query"""
    _fields_ = [
        ("body", Body),
        ("player", Player),
        ("point", Vec3),
        ("normal", Vec3),
        ("distance_m", c_double),
    ]


class Measures(Struct):
    """Sizes of a player's body, each in [0.05, 5] m times hh_player_def.scale.
    eye_height_m: standing
    shoulder_width_m: between the shoulder joints
    forearm_m: to the wrist"""
    _fields_ = [
        ("eye_height_m", c_double),
        ("shoulder_width_m", c_double),
        ("upper_arm_m", c_double),
        ("forearm_m", c_double),
    ]


class PlayerDef(Struct):
    """hh_player_def
    name: unique in the world; null: by its id
    origin: the space of the samples in the world
    mass_kg: default 80
    measures: Before scale: each in [0.05, 5] m. Default: unknown, the size is estimated from head and hands
    while the player plays, within 20 s and by less than 1 mm a step. Other measures stay.
    scale: Size of the player, [0.01, 100], default 1; else HH_ERROR_VALUE. Body, head, hands, reach and every
    number with hh_tuning_info.scales are times this. Samples and all results stay in the world's metres: a
    host gives the tracked poses times the scale. Tested from 0.1 to 20. The first hand of another scale than
    1 that grips a shape copies its surface, at about 0.2 microseconds a triangle.
    head_collides: the head is a sphere of head.radius_m times scale; default true
    layers: Layers of the head; it touches a body if each one's layers meet the other's mask.
    mask: Layers of the head; it touches a body if each one's layers meet the other's mask.
    grab_layers: the hands grip bodies with one of these layers; default all"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("name", c_char_p),
        ("origin", Pose),
        ("velocity_mps", Vec3),
        ("mass_kg", c_double),
        ("measures", Measures),
        ("scale", c_double),
        ("head_collides", c_uint8),
        ("layers", c_uint32),
        ("mask", c_uint32),
        ("grab_layers", c_uint32),
        ("user_data", c_uint64),
    ]
    _default_ = "hh_default_player_def_sized"


class HandState(Struct):
    """Grows: see base.h.
    body: gripped; null: none
    other: gripped player; null: none
    tracked: the wrist in the world, as the devices say
    shown: The wrist to draw. While it grips it is fitted to the surface near the anchor: centimetres from it,
    so that palm and fingers touch. A lost or never tracked hand that grips nothing hangs beside the trunk; it
    goes there and comes back at a bounded speed.
    anchor: The wrist in the frame of what it grips (a body, or a part of a player), from when the hand
    closed. The hand takes a new anchor after tracking errors, when the other hand of a shared grip lets go,
    and when the body's kind or mass changes.
    error_m: Distance of the tracked wrist from the anchor: 0 unless something blocks it.
    force_impulse_ns: Impulse of the hand on what it grips in the last step, for haptics. 0 if the host's
    solver moved the player (hh_world_end_step): read it there. While hands move only light bodies, the
    reported impulses of hands and contacts are limited to the momentum that the players and bodies involved
    have at their speeds plus the hands' speed.
    is_tracked: false while the hand is lost or inferred
    is_closed: the button is down
    is_inferred: The runtime guesses where the hand is (hh_tracking_sample.hand_inferred). `tracked` is the
    guess for an empty hand, and for a body in it while no hand of the player moves the player; else the last
    pose that was measured."""
    _fields_ = [
        ("grip", c_int32),
        ("body", Body),
        ("other", Player),
        ("tracked", Pose),
        ("shown", Pose),
        ("anchor", Pose),
        ("error_m", c_double),
        ("force_impulse_ns", Vec3),
        ("is_tracked", c_uint8),
        ("is_closed", c_uint8),
        ("is_inferred", c_uint8),
    ]


class PlayerPose(Struct):
    """Grows: see base.h. Later fields come behind `hands`.
    origin: The space of the samples in the world: put the camera rig here. Controllers at origin * sample are
    where the hands are, also after a recentring, which changes it so that nothing in the world moves.
    head: between the eyes, in the world
    velocity_mps: of the play space
    hands: by hh_side"""
    _fields_ = [
        ("origin", Pose),
        ("head", Pose),
        ("velocity_mps", Vec3),
        ("hands", HandState * 2),
    ]


class Event(Struct):
    """Grows: see base.h. Later versions also have more kinds and reasons: ignore those you do not know.
    player: null: a joint's event that concerns no hand
    side: hh_side; -1: no hand: the head or a joint alone
    body: touched, gripped, held or hit; null: a player, or nothing
    other: gripped or hit player; null: none
    held: contacts: what the hand holds; null: the head
    joint: whose latch or limit it is; null: none
    position: in the world: of the wrist, the contact, the joint or the head
    impulse_ns: of a contact that began: >= 0, for haptics and sound"""
    _fields_ = [
        ("kind", c_int32),
        ("reason", c_int32),
        ("player", Player),
        ("side", c_int32),
        ("body", Body),
        ("other", Player),
        ("held", Body),
        ("joint", Joint),
        ("position", Vec3),
        ("impulse_ns", c_double),
    ]


class HandJoint(Struct):
    """hh_hand_joint
    is_valid: false: the hand's rig has no such joint"""
    _fields_ = [
        ("pose", Pose),
        ("radius_m", c_double),
        ("is_valid", c_uint8),
    ]


class SkeletonJoint(Struct):
    """hh_skeleton_joint
    name: as in the engine's file; null: none
    parent: index; -1: a root
    is: HH_IS_..., for names that nobody can guess. Spine and palms need none: joints of the trunk follow by
    their height, joints of the palm follow the hand.
    bind: In the space given, without scale: T-pose or A-pose, +Y up, of any size and heading."""
    _fields_ = [
        ("name", c_char_p),
        ("parent", c_int32),
        ("is", c_int32),
        ("bind", Pose),
    ]


class Finger(Struct):
    """hh_finger
    is_posed: false: the finger closes on the surface as usual
    curl_rad: of its hinges, from the knuckle; each within pi
    opposition_rad: thumb; of a finger: spread towards the thumb, clamped to 0.17
    follows_trigger: The finger moves from these angles to the pressed ones as far as the sample's `trigger`
    is pressed. The pressed angles may reach into the body: a trigger gives way."""
    _fields_ = [
        ("is_posed", c_uint8),
        ("curl_rad", c_double * 3),
        ("opposition_rad", c_double),
        ("follows_trigger", c_uint8),
        ("pressed_curl_rad", c_double * 3),
        ("pressed_opposition_rad", c_double),
    ]


class GripHand(Struct):
    """hh_grip_hand
    is_used: false: this hand cannot take the grip
    wrist: in the body's frame
    fingers: thumb, index, middle, ring, little"""
    _fields_ = [
        ("is_used", c_uint8),
        ("wrist", Pose),
        ("fingers", Finger * 5),
    ]


class GripDef(Struct):
    """hh_grip_def
    hands: by hh_side
    priority: of several in reach, the highest is taken
    snap_radius_m: of the palm, [0, 10]; default 0.08
    snap_angle_rad: [0, pi]; default pi / 3"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("hands", GripHand * 2),
        ("priority", c_int32),
        ("snap_radius_m", c_double),
        ("snap_angle_rad", c_double),
    ]
    _default_ = "hh_default_grip_def_sized"


class SurfaceHit(Struct):
    """What a query found. Ignored, and counted as surface_answer_invalid: a body that is not in the world,
    numbers that are not finite, a point beyond 1e9 m, a normal of length zero.
    point: on the surface, in the world
    normal: out of the solid or towards the query; need not have length 1
    distance_m: see each query"""
    _fields_ = [
        ("body", Body),
        ("point", Vec3),
        ("normal", Vec3),
        ("distance_m", c_double),
    ]
SurfaceQueryCastRay = CFUNCTYPE(c_uint8, c_void_p, Vec3, Vec3, POINTER(Body), c_size_t, POINTER(SurfaceHit))
SurfaceQueryCastSphere = CFUNCTYPE(c_uint8, c_void_p, c_double, Vec3, Vec3, POINTER(Body), c_size_t, POINTER(SurfaceHit))
SurfaceQueryClosestPoint = CFUNCTYPE(c_uint8, c_void_p, Vec3, c_double, POINTER(Body), c_size_t, POINTER(SurfaceHit))
SurfaceQueryClosestPointOn = CFUNCTYPE(c_uint8, c_void_p, Body, Vec3, POINTER(SurfaceHit))


class SurfaceQuery(Struct):
    """Queries against the host's surfaces. Each returns true if it found something, and then fills `hit`.
    `skip`: bodies that count as not there. Called only inside hh_world_step, _step_hands, _begin_step,
    _end_step, _step_pose_only and hh_hand_find_grip of this world, by the thread that made that call. A query
    may read the world; calls that change it return HH_ERROR_STATE. Per player and frame: about 3 queries, up
    to 50 when a hand closes behind walls or among bodies.
    context: passed to each of the functions
    cast_ray: First surface that the segment hits, from outside or inside. distance_m is not read.
    cast_sphere: First impact of a sphere moving along a segment; distance_m: how far its centre has moved.
    For the distance grab (pull.reach_m above 0), and to keep trunk and legs out of surfaces: about one query
    per player and frame. Null: neither.
    closest_point: Nearest surface point within max_distance_m; distance_m: 0 inside a solid.
    closest_point_on: Nearest surface point of one body, at any distance; distance_m: 0 inside a solid."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("context", c_void_p),
        ("cast_ray", SurfaceQueryCastRay),
        ("cast_sphere", SurfaceQueryCastSphere),
        ("closest_point", SurfaceQueryClosestPoint),
        ("closest_point_on", SurfaceQueryClosestPointOn),
    ]
    _default_ = "hh_default_surface_query_sized"


class BodyMotion(Struct):
    """hh_body_motion
    pose: of the shape's own frame; without a shape: centre of mass and principal axes"""
    _fields_ = [
        ("body", Body),
        ("pose", Pose),
        ("velocity_mps", Vec3),
        ("angular_velocity_radps", Vec3),
    ]


class HandConstraint(Struct):
    """hh_hand_constraint
    anchor: the wrist in the body's frame
    target: the wrist at the end of the step: from the origin, with the world's axes
    velocity_mps: The target's velocity relative to the origin: the throwing velocity while a hand lets go,
    else the mean over the step.
    body_rotation: in the world, at the end of the step; not for POINT
    body_angular_velocity_radps: reaches body_rotation; not for POINT
    anchor_end: The anchor in the world at the end of the step, if the body keeps its velocity. Exact for
    static and kinematic bodies: a joint may attach the player to this point of the world.
    compliance_m_per_n: of the rows; 0: rigid, as in the runtime's own solver
    max_force_n: enough to stop what the hand drives from its highest speed in one step
    is_releasing: the hand lets go in this step"""
    _fields_ = [
        ("player", Player),
        ("side", c_int32),
        ("body", Body),
        ("rows", c_int32),
        ("anchor", Pose),
        ("target", Pose),
        ("velocity_mps", Vec3),
        ("angular_velocity_radps", Vec3),
        ("body_rotation", Quat),
        ("body_angular_velocity_radps", Vec3),
        ("anchor_end", Pose),
        ("compliance_m_per_n", c_double),
        ("max_force_n", c_double),
        ("is_releasing", c_uint8),
    ]


class PlayerMotion(Struct):
    """A player's body in the host's solver.
    origin: at the start of the step
    velocity_mps: at the start of the step, with thrusters and drag applied
    mass_kg: For this step. The player's own while a hand grips something static, kinematic or at least
    phases.heavy_body_kg. Else 1000 times the heaviest held body, so that light bodies do not shake the
    player; for bodies from phases.kappa_light_kg to phases.kappa_heavy_kg it falls to the player's own. If a
    held body meets something that does not give way, such as a crate at a wall, solve the step again with
    hh_player_def.mass_kg: the player then moves back by what the body could not move. Without that, hand and
    wall press against each other without a bound.
    head: of the head's centre: from the origin, with the world's axes
    head_radius_m: the host may let this sphere collide, on the player's body"""
    _fields_ = [
        ("player", Player),
        ("origin", Vec3),
        ("velocity_mps", Vec3),
        ("mass_kg", c_double),
        ("head", Pose),
        ("head_radius_m", c_double),
    ]


class SolvedPlayer(Struct):
    """hh_solved_player
    origin: at the end of the step
    velocity_mps: at the end of the step"""
    _fields_ = [
        ("player", Player),
        ("origin", Vec3),
        ("velocity_mps", Vec3),
    ]


class VelocityChange(Struct):
    """A velocity that the host gives its body."""
    _fields_ = [
        ("body", Body),
        ("velocity_mps", Vec3),
        ("angular_velocity_radps", Vec3),
    ]


class MatchDef(Struct):
    """hh_match_def
    role: default HH_MATCH_CLIENT
    players: by slot, the same on every machine; copied. All are in the world, also while nobody plays them
    player_count: [1, HH_MATCH_PLAYERS]
    tick_s: length of a tick, [1e-3, 0.1]; default 1/90
    slot: client: this machine's player; default 0
    sync_ticks: sync test: ticks stepped again each time, [1, 62]; default 8
    start_s: server: time on its clock at the world's present tick; default 0"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("role", c_int32),
        ("players", POINTER(Player)),
        ("player_count", c_size_t),
        ("tick_s", c_double),
        ("slot", c_uint32),
        ("sync_ticks", c_uint32),
        ("start_s", c_double),
    ]
    _default_ = "hh_default_match_def_sized"
    _arrays_ = {'players': ('player_count', 1)}
MatchGameStep = CFUNCTYPE(None, c_void_p, c_uint64, POINTER(c_uint32), c_size_t)
MatchGameSave = CFUNCTYPE(None, c_void_p, c_uint32)
MatchGameRestore = CFUNCTYPE(None, c_void_p, c_uint32)
MatchGameHash = CFUNCTYPE(c_uint64, c_void_p)


class MatchGame(Struct):
    """Your own state of the match, such as scores and doors' codes, which goes back and forth with the world's.
    Null functions are not called; `save` and `restore` come together. Inside of them no function of the match
    may be called, and none that steps, restores or destroys the world.
    context: passed to each of the functions
    step: Called after each step of the world to `tick`, also when it is stepped again. May read the world and
    its events, and may change its bodies, joints, grips and players; it must not add or remove any. What it
    does may depend on the world, your state, `tick` and `buttons` only: hh_match_input.buttons of each slot,
    of which there are `button_count`. What hosts draw, such as hh_player_pose, differs between machines.
    save: Keeps a copy of your state in a place of yours, [0, HH_MATCH_PLACES), over the one before. A server
    saves nothing.
    restore: Sets your state to the copy in that place.
    hash: Hash of your state: machines compare it together with the world's."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("context", c_void_p),
        ("step", MatchGameStep),
        ("save", MatchGameSave),
        ("restore", MatchGameRestore),
        ("hash", MatchGameHash),
    ]
    _default_ = "hh_default_match_game_sized"


class MatchInput(Struct):
    """A player's input for one tick. Fill by hh_default_match_input.
    buttons: your bits, for hh_match_game.step
    samples: As in hh_player_input, on the world's clock: a sample at the tick's end has hh_world_time plus
    tick_s. Later ones are kept for later ticks, at most 64. Poses become integers of 0.1 mm and 1 mrad, the
    same on every machine. Without a sample for 0.1 s devices count as not tracked.
    is_hidden: True: the tick is not shown, as by hh_world_step_simulated. For all but the last of several
    ticks in one frame. Default false."""
    _fields_ = [
        ("struct_size", c_uint32),
        ("buttons", c_uint32),
        ("samples", POINTER(TrackingSample)),
        ("sample_count", c_size_t),
        ("is_hidden", c_uint8),
        ("commands", Commands),
    ]
    _default_ = "hh_default_match_input_sized"
    _arrays_ = {'samples': ('sample_count', 1)}


class MatchDifference(Struct):
    """The first tick whose hash changed when it was stepped again.
    tick: 0: none
    in_world: hh_world_simulated_hash differs
    in_game: hh_match_game.hash differs"""
    _fields_ = [
        ("tick", c_uint64),
        ("in_world", c_uint8),
        ("in_game", c_uint8),
    ]


class MatchEvent(Struct):
    """Grows with hh_event, its last field.
    event: `position` is that of the tracked hand, not of the shown one"""
    _fields_ = [
        ("tick", c_uint64),
        ("state", c_int32),
        ("event", Event),
    ]


class MatchStats(Struct):
    """Counts since the match began, where nothing else is said.
    tick: the world's present tick
    confirmed: the last tick whose state is final here
    ticks: ticks that the world advanced
    rollbacks: clients, sync tests: times that the world went back
    steps_again: ticks stepped again by them
    deepest: most ticks that one of them stepped again
    waits: clients: hh_match_advance that were too far ahead
    filled: inputs that came too late: own ones, or on a server those of all
    hashes: servers, spectators: compared hashes
    out_of_sync: servers, spectators: those that differed
    refused: packets, by hh_match_refusal; on clients, GAP counts their parts"""
    _fields_ = [
        ("struct_size", c_uint32),
        ("tick", c_uint64),
        ("confirmed", c_uint64),
        ("ticks", c_uint64),
        ("rollbacks", c_uint64),
        ("steps_again", c_uint64),
        ("deepest", c_uint64),
        ("waits", c_uint64),
        ("filled", c_uint64),
        ("hashes", c_uint64),
        ("out_of_sync", c_uint64),
        ("refused", c_uint64 * 16),
    ]
    _default_ = "hh_default_match_stats_sized"


# Result and parameters of each function.
FUNCTIONS = {
    "hh_result_text": (c_char_p, [c_int32]),
    "hh_last_error": (c_char_p, []),
    "hh_version": (None, [POINTER(c_uint32), POINTER(c_uint32), POINTER(c_uint32)]),
    "hh_identity_pose": (Pose, []),
    "hh_sin_cos": (None, [c_double, POINTER(c_double), POINTER(c_double)]),
    "hh_atan2": (c_double, [c_double, c_double]),
    "hh_default_host_hooks_sized": (c_int32, [POINTER(HostHooks), c_size_t]),
    "hh_set_host_hooks": (c_int32, [POINTER(HostHooks)]),
    "hh_set_thread_count": (c_int32, [c_uint32]),
    "hh_thread_count": (c_uint32, []),
    "hh_convert_metres_per_unit": (c_double, [c_int32]),
    "hh_convert_vector_from": (Vec3, [c_int32, Vec3]),
    "hh_convert_vector_to": (Vec3, [c_int32, Vec3]),
    "hh_convert_direction_from": (Vec3, [c_int32, Vec3]),
    "hh_convert_direction_to": (Vec3, [c_int32, Vec3]),
    "hh_convert_angular_from": (Vec3, [c_int32, Vec3]),
    "hh_convert_angular_to": (Vec3, [c_int32, Vec3]),
    "hh_convert_rotation_from": (Quat, [c_int32, Quat]),
    "hh_convert_rotation_to": (Quat, [c_int32, Quat]),
    "hh_convert_pose_from": (Pose, [c_int32, Pose]),
    "hh_convert_pose_to": (Pose, [c_int32, Pose]),
    "hh_convert_scale_from": (Vec3, [c_int32, Vec3]),
    "hh_convert_scale_to": (Vec3, [c_int32, Vec3]),
    "hh_convert_mesh_from": (c_int32, [c_int32, POINTER(c_float), c_size_t, POINTER(c_uint32), c_size_t]),
    "hh_default_world_def_sized": (c_int32, [POINTER(WorldDef), c_size_t]),
    "hh_world_create": (c_int32, [POINTER(WorldDef), POINTER(c_void_p)]),
    "hh_world_destroy": (None, [c_void_p]),
    "hh_default_tracking_sample_sized": (c_int32, [POINTER(TrackingSample), c_size_t]),
    "hh_default_player_input_sized": (c_int32, [POINTER(PlayerInput), c_size_t]),
    "hh_world_step": (c_int32, [c_void_p, c_double, POINTER(PlayerInput), c_size_t]),
    "hh_world_step_simulated": (c_int32, [c_void_p, c_double, POINTER(PlayerInput), c_size_t]),
    "hh_world_step_pose_only": (c_int32, [c_void_p, c_double, POINTER(PlayerInput), c_size_t]),
    "hh_world_time": (c_int32, [c_void_p, POINTER(c_double), POINTER(c_uint64)]),
    "hh_world_set_gravity": (c_int32, [c_void_p, Vec3]),
    "hh_world_set_reference_velocity": (c_int32, [c_void_p, Vec3]),
    "hh_world_gravity": (c_int32, [c_void_p, POINTER(Vec3)]),
    "hh_world_reference_velocity": (c_int32, [c_void_p, POINTER(Vec3)]),
    "hh_world_hash": (c_int32, [c_void_p, POINTER(c_uint64)]),
    "hh_world_simulated_hash": (c_int32, [c_void_p, POINTER(c_uint64)]),
    "hh_world_save": (c_int32, [c_void_p, c_void_p, c_size_t, POINTER(c_size_t)]),
    "hh_world_restore": (c_int32, [c_void_p, c_void_p, c_size_t]),
    "hh_default_world_stats_sized": (c_int32, [POINTER(WorldStats), c_size_t]),
    "hh_world_get_stats": (c_int32, [c_void_p, POINTER(WorldStats)]),
    "hh_stage_name": (c_char_p, [c_size_t]),
    "hh_fallback_name": (c_char_p, [c_size_t]),
    "hh_world_stage_times": (c_int32, [c_void_p, POINTER(c_double), c_size_t, POINTER(c_size_t)]),
    "hh_world_fallbacks": (c_int32, [c_void_p, POINTER(c_uint64), c_size_t, POINTER(c_size_t)]),
    "hh_default_tuning_info_sized": (c_int32, [POINTER(TuningInfo), c_size_t]),
    "hh_tuning_describe": (c_int32, [c_size_t, POINTER(TuningInfo)]),
    "hh_world_get_tuning": (c_int32, [c_void_p, c_char_p, POINTER(c_double), c_size_t]),
    "hh_world_set_tuning": (c_int32, [c_void_p, c_char_p, POINTER(c_double), c_size_t]),
    "hh_world_tuning_numbers": (c_int32, [c_void_p, POINTER(c_double), c_size_t, POINTER(c_size_t)]),
    "hh_world_set_tuning_numbers": (c_int32, [c_void_p, POINTER(c_double), c_size_t]),
    "hh_world_load_tuning": (c_int32, [c_void_p, c_char_p, c_size_t]),
    "hh_world_load_body_clips": (c_int32, [c_void_p, c_char_p, c_size_t]),
    "hh_shape_add_box": (c_int32, [c_void_p, Vec3, POINTER(Shape)]),
    "hh_shape_add_sphere": (c_int32, [c_void_p, c_double, POINTER(Shape)]),
    "hh_shape_add_capsule": (c_int32, [c_void_p, c_double, c_double, POINTER(Shape)]),
    "hh_shape_add_cylinder": (c_int32, [c_void_p, c_double, c_double, POINTER(Shape)]),
    "hh_shape_add_hull": (c_int32, [c_void_p, POINTER(Vec3), c_size_t, POINTER(Shape)]),
    "hh_shape_add_compound": (c_int32, [c_void_p, POINTER(CompoundPart), c_size_t, POINTER(Shape)]),
    "hh_default_mesh_def_sized": (c_int32, [POINTER(MeshDef), c_size_t]),
    "hh_mesh_create": (c_int32, [POINTER(MeshDef), POINTER(c_void_p)]),
    "hh_mesh_destroy": (None, [c_void_p]),
    "hh_shape_add_mesh": (c_int32, [c_void_p, c_void_p, Vec3, POINTER(Shape)]),
    "hh_shape_remove": (c_int32, [c_void_p, Shape]),
    "hh_shape_is_valid": (c_uint8, [c_void_p, Shape]),
    "hh_world_shape_count": (c_int32, [c_void_p, POINTER(c_size_t)]),
    "hh_default_body_def_sized": (c_int32, [POINTER(BodyDef), c_size_t]),
    "hh_body_add": (c_int32, [c_void_p, POINTER(BodyDef), POINTER(Body)]),
    "hh_body_remove": (c_int32, [c_void_p, Body]),
    "hh_body_is_valid": (c_uint8, [c_void_p, Body]),
    "hh_body_find": (c_int32, [c_void_p, c_char_p, POINTER(Body)]),
    "hh_body_name": (c_int32, [c_void_p, Body, POINTER(c_char_p)]),
    "hh_world_bodies": (c_int32, [c_void_p, POINTER(Body), c_size_t, POINTER(c_size_t)]),
    "hh_body_pose": (c_int32, [c_void_p, Body, POINTER(Pose)]),
    "hh_world_body_poses": (c_int32, [c_void_p, POINTER(Body), c_size_t, POINTER(Pose)]),
    "hh_body_velocity": (c_int32, [c_void_p, Body, POINTER(Vec3), POINTER(Vec3)]),
    "hh_body_set_velocity": (c_int32, [c_void_p, Body, Vec3, Vec3]),
    "hh_body_apply_impulse": (c_int32, [c_void_p, Body, Vec3, Vec3]),
    "hh_body_teleport": (c_int32, [c_void_p, Body, Pose]),
    "hh_body_move_kinematic": (c_int32, [c_void_p, Body, Pose]),
    "hh_body_set_gravity_scale": (c_int32, [c_void_p, Body, c_double]),
    "hh_body_set_layers": (c_int32, [c_void_p, Body, c_uint32, c_uint32]),
    "hh_body_set_grab_rule": (c_int32, [c_void_p, Body, c_uint8, c_uint8, c_uint8, c_int32]),
    "hh_body_get_kind": (c_int32, [c_void_p, Body, POINTER(c_int32)]),
    "hh_body_mass": (c_int32, [c_void_p, Body, POINTER(c_double)]),
    "hh_body_set_mass": (c_int32, [c_void_p, Body, c_double, Vec3]),
    "hh_body_material": (c_int32, [c_void_p, Body, POINTER(c_double), POINTER(c_double)]),
    "hh_body_set_material": (c_int32, [c_void_p, Body, c_double, c_double]),
    "hh_body_set_kind": (c_int32, [c_void_p, Body, c_int32, c_double, Vec3]),
    "hh_body_shape": (c_int32, [c_void_p, Body, POINTER(Shape)]),
    "hh_body_set_shape": (c_int32, [c_void_p, Body, Shape]),
    "hh_body_set_user_data": (c_int32, [c_void_p, Body, c_uint64]),
    "hh_body_user_data": (c_int32, [c_void_p, Body, POINTER(c_uint64)]),
    "hh_world_add_gltf_level": (c_int32, [c_void_p, c_void_p, c_size_t, Pose, POINTER(Body), c_size_t, POINTER(c_size_t)]),
    "hh_default_joint_def_sized": (c_int32, [POINTER(JointDef), c_size_t]),
    "hh_joint_add": (c_int32, [c_void_p, POINTER(JointDef), POINTER(Joint)]),
    "hh_joint_remove": (c_int32, [c_void_p, Joint]),
    "hh_joint_is_valid": (c_uint8, [c_void_p, Joint]),
    "hh_body_joints": (c_int32, [c_void_p, Body, POINTER(Joint), c_size_t, POINTER(c_size_t)]),
    "hh_default_motor_def_sized": (c_int32, [POINTER(MotorDef), c_size_t]),
    "hh_joint_set_motor": (c_int32, [c_void_p, Joint, POINTER(MotorDef)]),
    "hh_joint_set_limits": (c_int32, [c_void_p, Joint, c_uint8, c_double, c_double]),
    "hh_joint_set_latch": (c_int32, [c_void_p, Joint, c_double, c_double, c_double]),
    "hh_joint_set_friction": (c_int32, [c_void_p, Joint, c_double]),
    "hh_joint_state": (c_int32, [c_void_p, Joint, POINTER(c_double), POINTER(c_double), POINTER(c_uint8)]),
    "hh_world_contacts": (c_int32, [c_void_p, POINTER(Contact), c_size_t, POINTER(c_size_t)]),
    "hh_world_cast_ray": (c_int32, [c_void_p, Vec3, Vec3, Player, POINTER(Hit)]),
    "hh_world_cast_sphere": (c_int32, [c_void_p, c_double, Vec3, Vec3, Player, POINTER(Hit)]),
    "hh_world_closest_point": (c_int32, [c_void_p, Vec3, c_double, Player, POINTER(Hit)]),
    "hh_world_overlap_sphere": (c_int32, [c_void_p, Vec3, c_double, Player, POINTER(Hit), c_size_t, POINTER(c_size_t)]),
    "hh_default_player_def_sized": (c_int32, [POINTER(PlayerDef), c_size_t]),
    "hh_player_add": (c_int32, [c_void_p, POINTER(PlayerDef), POINTER(Player)]),
    "hh_player_remove": (c_int32, [c_void_p, Player]),
    "hh_player_is_valid": (c_uint8, [c_void_p, Player]),
    "hh_world_players": (c_int32, [c_void_p, POINTER(Player), c_size_t, POINTER(c_size_t)]),
    "hh_player_recenter": (c_int32, [c_void_p, Player, Pose]),
    "hh_player_set_recenter_guess": (c_int32, [c_void_p, Player, c_uint8]),
    "hh_player_teleport": (c_int32, [c_void_p, Player, Pose]),
    "hh_player_velocity": (c_int32, [c_void_p, Player, POINTER(Vec3)]),
    "hh_player_set_velocity": (c_int32, [c_void_p, Player, Vec3]),
    "hh_player_reference_velocity": (c_int32, [c_void_p, Player, POINTER(Vec3)]),
    "hh_player_push_back": (c_int32, [c_void_p, Player, POINTER(c_double)]),
    "hh_player_mass": (c_int32, [c_void_p, Player, POINTER(c_double)]),
    "hh_player_head": (c_int32, [c_void_p, Player, POINTER(Vec3), POINTER(c_double), POINTER(c_uint8)]),
    "hh_player_measures": (c_int32, [c_void_p, Player, POINTER(Measures)]),
    "hh_player_set_measures": (c_int32, [c_void_p, Player, POINTER(Measures)]),
    "hh_player_set_user_data": (c_int32, [c_void_p, Player, c_uint64]),
    "hh_player_user_data": (c_int32, [c_void_p, Player, POINTER(c_uint64)]),
    "hh_player_set_hand_in_controller": (c_int32, [c_void_p, Player, c_int32, POINTER(Pose)]),
    "hh_player_hand_in_controller": (c_int32, [c_void_p, Player, c_int32, POINTER(Pose)]),
    "hh_world_hand_in_controller": (c_int32, [c_void_p, c_int32, POINTER(Pose)]),
    "hh_player_hand_sized": (c_int32, [c_void_p, Player, c_int32, POINTER(HandState), c_size_t]),
    "hh_hand_moves_player": (c_int32, [c_void_p, Player, c_int32, POINTER(c_uint8)]),
    "hh_world_player_poses_sized": (c_int32, [c_void_p, POINTER(Player), c_size_t, POINTER(PlayerPose), c_size_t, c_size_t]),
    "hh_hand_grip": (c_int32, [c_void_p, Player, c_int32, Body]),
    "hh_hand_release": (c_int32, [c_void_p, Player, c_int32]),
    "hh_event_kind_name": (c_char_p, [c_int32]),
    "hh_reason_name": (c_char_p, [c_int32]),
    "hh_world_events_sized": (c_int32, [c_void_p, POINTER(POINTER(Event)), POINTER(c_size_t), c_size_t]),
    "hh_finger_curls_of": (c_int32, [POINTER(HandJoint), POINTER(FingerCurls)]),
    "hh_player_hand_joints": (c_int32, [c_void_p, Player, c_int32, c_int32, POINTER(HandJoint)]),
    "hh_body_joint_name": (c_char_p, [c_size_t]),
    "hh_body_joint_parent": (c_int32, [c_size_t]),
    "hh_player_body_joints": (c_int32, [c_void_p, Player, c_int32, POINTER(Pose)]),
    "hh_player_set_hand_rig": (c_int32, [c_void_p, Player, c_int32, c_void_p, c_size_t]),
    "hh_player_set_body_rig": (c_int32, [c_void_p, Player, c_void_p, c_size_t]),
    "hh_player_set_body_skeleton": (c_int32, [c_void_p, Player, POINTER(SkeletonJoint), c_size_t, c_int32]),
    "hh_player_skeleton": (c_int32, [c_void_p, Player, c_int32, POINTER(Pose), c_size_t, POINTER(c_size_t)]),
    "hh_player_skeleton_joint": (c_int32, [c_void_p, Player, c_size_t, POINTER(c_char_p), POINTER(c_int32)]),
    "hh_player_skeleton_fingers": (c_int32, [c_void_p, Player, c_int32, POINTER(c_size_t)]),
    "hh_default_grip_def_sized": (c_int32, [POINTER(GripDef), c_size_t]),
    "hh_body_add_grip": (c_int32, [c_void_p, Body, POINTER(GripDef)]),
    "hh_default_surface_query_sized": (c_int32, [POINTER(SurfaceQuery), c_size_t]),
    "hh_world_set_surface_query": (c_int32, [c_void_p, POINTER(SurfaceQuery)]),
    "hh_body_set_surface": (c_int32, [c_void_p, Body, c_void_p]),
    "hh_world_place_bodies": (c_int32, [c_void_p, POINTER(BodyMotion), c_size_t]),
    "hh_player_place": (c_int32, [c_void_p, Player, Pose, Vec3]),
    "hh_hand_hold": (c_int32, [c_void_p, Player, c_int32, Body, POINTER(Pose)]),
    "hh_hand_find_grip": (c_int32, [c_void_p, Player, c_int32, POINTER(SurfaceHit)]),
    "hh_world_step_hands": (c_int32, [c_void_p, c_double, POINTER(PlayerInput), c_size_t]),
    "hh_world_begin_step": (c_int32, [c_void_p, c_double, POINTER(PlayerInput), c_size_t]),
    "hh_world_hand_constraints": (c_int32, [c_void_p, POINTER(POINTER(HandConstraint)), POINTER(c_size_t)]),
    "hh_world_player_motions": (c_int32, [c_void_p, POINTER(POINTER(PlayerMotion)), POINTER(c_size_t)]),
    "hh_world_end_step": (c_int32, [c_void_p, POINTER(SolvedPlayer), c_size_t]),
    "hh_world_velocity_changes": (c_int32, [c_void_p, POINTER(POINTER(VelocityChange)), POINTER(c_size_t)]),
    "hh_world_held_bodies": (c_int32, [c_void_p, POINTER(Body), c_size_t, POINTER(c_size_t)]),
    "hh_default_match_def_sized": (c_int32, [POINTER(MatchDef), c_size_t]),
    "hh_default_match_game_sized": (c_int32, [POINTER(MatchGame), c_size_t]),
    "hh_match_create": (c_int32, [c_void_p, POINTER(MatchDef), POINTER(MatchGame), POINTER(c_void_p)]),
    "hh_match_destroy": (None, [c_void_p]),
    "hh_default_match_input_sized": (c_int32, [POINTER(MatchInput), c_size_t]),
    "hh_match_ticks_due": (c_int32, [c_void_p, c_double, POINTER(c_uint32)]),
    "hh_match_advance": (c_int32, [c_void_p, POINTER(MatchInput), POINTER(c_uint8)]),
    "hh_match_receive": (c_int32, [c_void_p, c_void_p, c_size_t]),
    "hh_match_packet": (c_int32, [c_void_p, c_void_p, c_size_t, POINTER(c_size_t)]),
    "hh_match_join": (c_int32, [c_void_p, c_void_p, c_size_t]),
    "hh_match_connect": (c_int32, [c_void_p, c_uint32]),
    "hh_match_disconnect": (c_int32, [c_void_p, c_uint32]),
    "hh_match_receive_from": (c_int32, [c_void_p, c_uint32, c_double, c_void_p, c_size_t]),
    "hh_match_confirm": (c_int32, [c_void_p, c_double, POINTER(c_uint32)]),
    "hh_match_packet_to": (c_int32, [c_void_p, c_uint32, c_void_p, c_size_t, POINTER(c_size_t)]),
    "hh_match_state": (c_int32, [c_void_p, c_uint32, c_void_p, c_size_t, POINTER(c_size_t)]),
    "hh_match_sync_test": (c_int32, [c_void_p, POINTER(MatchInput), c_size_t, POINTER(MatchDifference)]),
    "hh_match_confirmed_inputs": (c_int32, [c_void_p, c_uint64, c_void_p, c_size_t, POINTER(c_size_t), POINTER(c_uint64)]),
    "hh_match_needs_state": (c_int32, [c_void_p, c_uint32, POINTER(c_uint8)]),
    "hh_match_hash": (c_int32, [c_void_p, c_uint64, POINTER(c_uint64)]),
    "hh_match_shown_offsets": (c_int32, [c_void_p, c_uint32, POINTER(Vec3), POINTER(Vec3), POINTER(Vec3)]),
    "hh_match_drawn_player": (c_int32, [c_void_p, c_uint32, POINTER(TrackingSample), POINTER(Pose), POINTER(Pose), POINTER(Pose), POINTER(Pose)]),
    "hh_match_drawn_bodies": (c_int32, [c_void_p, POINTER(Body), c_size_t, POINTER(Pose)]),
    "hh_match_events_sized": (c_int32, [c_void_p, POINTER(POINTER(MatchEvent)), POINTER(c_size_t), c_size_t]),
    "hh_default_match_stats_sized": (c_int32, [POINTER(MatchStats), c_size_t]),
    "hh_match_get_stats": (c_int32, [c_void_p, POINTER(MatchStats)]),
}


def result_text(result):
    """The result's name, "HH_ERROR_HANDLE". Never null. Any thread."""
    return shown(lib().hh_result_text(result))


def version():
    """The version of the library that is running: compare with HANDHOLD_VERSION_MAJOR and so on. Null pointers
    are skipped. Any thread."""
    major = c_uint32()
    minor = c_uint32()
    patch = c_uint32()
    lib().hh_version(byref(major), byref(minor), byref(patch))
    return major.value, minor.value, patch.value


def identity_pose():
    """The pose at the origin, not rotated. Any thread."""
    return lib().hh_identity_pose()


def sin_cos(angle_rad):
    """Equal on every machine and compiler, unlike sin, cos and atan2 of C: for inputs that must replay bit for
    bit. Errors are below 1e-14 up to 1e6 rad; beyond that, and for NaN, sine is 0 and cosine 1. Null outputs
    are skipped. hh_atan2 gives 0 for (0, 0) and NaN. Any thread."""
    sine = c_double()
    cosine = c_double()
    lib().hh_sin_cos(angle_rad, byref(sine), byref(cosine))
    return sine.value, cosine.value


def atan2(y, x):
    return lib().hh_atan2(y, x)


def set_host_hooks(hooks=None):
    """Sets the hooks of the process; null: back to the defaults. HH_ERROR_STATE while a world exists. Not beside
    any other call of the library."""
    hooks = held(HostHooks, hooks)
    check(lib().hh_set_host_hooks(optional(HostHooks, hooks)))
    _kept["hh_host_hooks"] = hooks


def set_thread_count(count):
    """Sets the number of threads of the library's own pool, [1, 256]. Allowed while worlds exist, for instance
    to use all cores while a level loads. HH_ERROR_STATE if the host lends parallel_for. Not beside any other
    call of the library."""
    check(lib().hh_set_thread_count(count))


def thread_count():
    """Number of threads of the library's own pool, the caller's included. Any thread."""
    return lib().hh_thread_count()


def convert_metres_per_unit(engine):
    """Metres in one of the engine's units of length: 0.01 for Unreal, else 1. For radii and distances."""
    return lib().hh_convert_metres_per_unit(engine)


def convert_vector_from(engine, vector):
    """Whatever scales with length: positions, velocities, accelerations, impulses, forces."""
    return lib().hh_convert_vector_from(engine, value(Vec3, vector))


def convert_vector_to(engine, vector):
    return lib().hh_convert_vector_to(engine, value(Vec3, vector))


def convert_direction_from(engine, direction):
    """Directions without a length: normals, axes."""
    return lib().hh_convert_direction_from(engine, value(Vec3, direction))


def convert_direction_to(engine, direction):
    return lib().hh_convert_direction_to(engine, value(Vec3, direction))


def convert_angular_from(engine, angular_radps):
    """Angular velocities in rad/s, and other vectors along an axis of rotation. Left-handed engines count angles
    the other way, so the sign changes too."""
    return lib().hh_convert_angular_from(engine, value(Vec3, angular_radps))


def convert_angular_to(engine, angular_radps):
    return lib().hh_convert_angular_to(engine, value(Vec3, angular_radps))


def convert_rotation_from(engine, rotation):
    return lib().hh_convert_rotation_from(engine, value(Quat, rotation))


def convert_rotation_to(engine, rotation):
    return lib().hh_convert_rotation_to(engine, value(Quat, rotation))


def convert_pose_from(engine, pose):
    return lib().hh_convert_pose_from(engine, value(Pose, pose))


def convert_pose_to(engine, pose):
    return lib().hh_convert_pose_to(engine, value(Pose, pose))


def convert_scale_from(engine, scale):
    """Scale factors of an object along its own axes, and half extents in metres: axes change places, signs do
    not."""
    return lib().hh_convert_scale_from(engine, value(Vec3, scale))


def convert_scale_to(engine, scale):
    return lib().hh_convert_scale_to(engine, value(Vec3, scale))


def convert_mesh_from(engine, coordinates, indices):
    """Converts a mesh in place: x, y, z of its vertices. Reverses its triangles if the engine's front faces are
    clockwise (Unity, Godot), so that they are counter-clockwise from outside. A mirrored object, of which the
    product of the scales is negative, needs nothing else: give its scale, from hh_convert_scale_from, to
    hh_shape_add_mesh, which takes negative factors. HH_ERROR_VALUE, and no change, for counts that are no
    multiples of 3."""
    coordinates, coordinates_at = changed(c_float, coordinates)
    indices, indices_at = changed(c_uint32, indices)
    check(lib().hh_convert_mesh_from(engine, coordinates_at, coordinates.size, indices_at, indices.size))
    return coordinates, indices


def stage_name(stage):
    """Stages and fallbacks by index; null beyond the last. A fallback is counted whenever the runtime does the
    next best instead of what was asked. Any thread."""
    return shown(lib().hh_stage_name(stage))


def fallback_name(fallback):
    return shown(lib().hh_fallback_name(fallback))


def tuning_describe(index):
    """The number with this index; HH_ERROR_VALUE beyond the last. Any thread."""
    info = TuningInfo()
    check(lib().hh_tuning_describe(index, byref(info)))
    return info


def event_kind_name(kind):
    """"grabbed", "no_surface"; null for numbers that this version does not know. Any thread."""
    return shown(lib().hh_event_kind_name(kind))


def reason_name(reason):
    return shown(lib().hh_reason_name(reason))


def finger_curls_of(joints):
    """How far the fingers of a tracked hand are bent, for hh_tracking_sample.curls. `joints`:
    HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name, in any one space; only positions are read. Curl is
    the sum of a finger's bends over that of a fist; -1 if a joint of the finger is not valid. Any thread."""
    joints = fixed(HandJoint, joints, 26, "joints")
    curls = FingerCurls()
    check(lib().hh_finger_curls_of(joints, byref(curls)))
    return curls


def body_joint_name(joint):
    """"leftUpperArm"; null beyond the last. Any thread."""
    return shown(lib().hh_body_joint_name(joint))


def body_joint_parent(joint):
    """The parent's index; -1 for the hips and beyond the last."""
    return lib().hh_body_joint_parent(joint)


class WorldCalls:
    """Every function of a world, as a method. Calls that the library refuses raise HandholdError and change nothing."""

    _handle = None

    def step(self, dt_s, inputs):
        """Steps the world by dt_s, in [1e-6, 10]; 1/90 is usual. `inputs`: at most one a player, else
        HH_ERROR_VALUE; players without one are silent. Bad samples are ignored and counted; numbers in
        commands that are out of range are clamped. Cost: about 0.03 ms for a player who crawls, 0.05 ms for
        one who grips and lets go all the time, and up to 4 ms in the frame in which a hand closes:
        docs/guide/cost.md."""
        inputs, input_count_ = array(PlayerInput, inputs)
        check(lib().hh_world_step(self._handle, dt_s, inputs, input_count_))

    def step_simulated(self, dt_s, inputs):
        """hh_world_step without fitted hands, arms, spine and legs: about a quarter of its cost. What hosts draw
        stays as the last other step left it: hh_player_pose with its hands, joints of hands and bodies,
        hh_player_push_back. Everything else changes exactly as in hh_world_step, bit for bit:
        hh_world_simulated_hash is equal whichever steps were shown. For rollback: step again to the present
        with this, and the last time with hh_world_step. Events carry the tracked hand's position."""
        inputs, input_count_ = array(PlayerInput, inputs)
        check(lib().hh_world_step_simulated(self._handle, dt_s, inputs, input_count_))

    def step_pose_only(self, dt_s, inputs):
        """While the game is paused: heads, hands and bodies of players follow their last sample, whatever its
        time. The clock, bodies, joints, grips and play spaces stand still. Samples that were waiting for
        their step are dropped. The next hh_world_step goes on: hands that are still closed grip where they
        are at that time."""
        inputs, input_count_ = array(PlayerInput, inputs)
        check(lib().hh_world_step_pose_only(self._handle, dt_s, inputs, input_count_))

    def time(self):
        """The world's clock, seconds, and the number of steps. Null outputs are skipped."""
        time_s = c_double()
        frame = c_uint64()
        check(lib().hh_world_time(self._handle, byref(time_s), byref(frame)))
        return time_s.value, frame.value

    def set_gravity(self, gravity_mps2):
        """Acceleration of dynamic bodies; players float. Each axis within 1e4 m/s^2."""
        check(lib().hh_world_set_gravity(self._handle, value(Vec3, gravity_mps2)))

    def set_reference_velocity(self, velocity_mps):
        """Velocity of the scene: drifting players come to rest against it. Each axis within 1e6 m/s."""
        check(lib().hh_world_set_reference_velocity(self._handle, value(Vec3, velocity_mps)))

    def gravity(self):
        gravity_mps2 = Vec3()
        check(lib().hh_world_gravity(self._handle, byref(gravity_mps2)))
        return gravity_mps2

    def reference_velocity(self):
        velocity_mps = Vec3()
        check(lib().hh_world_reference_velocity(self._handle, byref(velocity_mps)))
        return velocity_mps

    def hash(self):
        """Hash of the whole state. Equal on every machine, compiler and number of threads after equal calls with
        equal names. Not in it: which shape a body has, because ids depend on the order of loading. Cost:
        linear in the state, about 0.1 ms for a scene of 100 bodies."""
        hash = c_uint64()
        check(lib().hh_world_hash(self._handle, byref(hash)))
        return hash.value

    def simulated_hash(self):
        """The same of the simulated state alone, without what hosts draw. Machines that show different frames,
        or none, compare this."""
        hash = c_uint64()
        check(lib().hh_world_simulated_hash(self._handle, byref(hash)))
        return hash.value

    def save(self):
        """Saves every bit of the state. Writes the number of bytes to `size`. A null `buffer` only asks for it.
        HH_ERROR_CAPACITY if it is more than `capacity`. Rigs, tuning and user data are not in a snapshot.
        Shapes are named by their content: a world that restores it needs equal ones, whatever their ids."""
        return listed(c_uint8, lambda buffer, capacity, count: lib().hh_world_save(self._handle, buffer, capacity, count))

    def restore(self, bytes):
        """Back to a saved state, which then goes on bit for bit. Ids taken before the save are valid again.
        HH_ERROR_DATA, and no change, for bytes that are damaged or name a shape that this world has not.
        Tolerates any bytes."""
        bytes, size_ = raw(bytes)
        check(lib().hh_world_restore(self._handle, bytes, size_))

    def get_stats(self):
        stats = WorldStats()
        check(lib().hh_world_get_stats(self._handle, byref(stats)))
        return stats

    def stage_times(self):
        """Time of each stage, microseconds, and how often each fallback occurred, in the last step. `count` gets
        the number of entries; HH_ERROR_CAPACITY if it is more than `capacity`."""
        return listed(c_double, lambda buffer, capacity, count: lib().hh_world_stage_times(self._handle, buffer, capacity, count))

    def fallbacks(self):
        return listed(c_uint64, lambda buffer, capacity, count: lib().hh_world_fallbacks(self._handle, buffer, capacity, count))

    def get_tuning(self, name, count):
        """Reads and changes one number by name, between steps. `count` must be the number's. HH_ERROR_NAME for
        an unknown name, HH_ERROR_VALUE out of range."""
        values, values_at = empty(c_double, count)
        check(lib().hh_world_get_tuning(self._handle, text(name), values_at, count))
        return values

    def set_tuning(self, name, values):
        values, count_ = array(c_double, values)
        check(lib().hh_world_set_tuning(self._handle, text(name), values, count_))

    def tuning_numbers(self):
        """All numbers of the tuning, to compare, keep and restore: in the order of hh_tuning_describe, a vector
        as three. `count` as for hh_world_fallbacks. Set takes exactly all of them; on an error none changes."""
        return listed(c_double, lambda buffer, capacity, count: lib().hh_world_tuning_numbers(self._handle, buffer, capacity, count))

    def set_tuning_numbers(self, values):
        values, count_ = array(c_double, values)
        check(lib().hh_world_set_tuning_numbers(self._handle, values, count_))

    def load_tuning(self, json):
        """All numbers from JSON, {"hand": {"reach_m": 0.12}}; those that it lacks get their defaults.
        HH_ERROR_DATA, with the place, for unknown names and wrong numbers."""
        json, size_ = raw(json)
        check(lib().hh_world_load_tuning(self._handle, json, size_))

    def load_body_clips(self, json):
        """The additive body clips of all players, from JSON in the format of docs/reference/body_clips.md:
        idling, pushing off, looking round, raising the arms. They rotate spine, legs and clavicles, never
        hands. They replace the clips before. Null: none, which is the default. HH_ERROR_DATA, with the place
        and no change, for anything else. Clips are not in a snapshot: load the same ones before you restore."""
        json, size_ = raw(json)
        check(lib().hh_world_load_body_clips(self._handle, json, size_))

    def shape_add_box(self, half_extents_m):
        """In a world with fits_hands, a new shape gets a surface for hands on the calling thread; a shape equal
        to one that is there costs microseconds. Costs are of one core at 2.1 GHz. Large round shapes cost
        more than a frame: add them while loading. Box: 0.02 ms."""
        shape = Shape()
        check(lib().hh_shape_add_box(self._handle, value(Vec3, half_extents_m), byref(shape)))
        return shape

    def shape_add_sphere(self, radius_m):
        """Cost with fits_hands: 2 ms at 0.1 m, growing with the radius to 18 ms at 1 m; none above 64 m."""
        shape = Shape()
        check(lib().hh_shape_add_sphere(self._handle, radius_m, byref(shape)))
        return shape

    def shape_add_capsule(self, radius_m, half_height_m):
        """Along Y; half_height_m without the caps. Cost: as a sphere."""
        shape = Shape()
        check(lib().hh_shape_add_capsule(self._handle, radius_m, half_height_m, byref(shape)))
        return shape

    def shape_add_cylinder(self, radius_m, half_height_m):
        """Along Y. Cost with fits_hands: 0.4 ms at 0.1 m."""
        shape = Shape()
        check(lib().hh_shape_add_cylinder(self._handle, radius_m, half_height_m, byref(shape)))
        return shape

    def shape_add_hull(self, points):
        """Convex hull of points that are not coplanar. Cost with fits_hands: 1.6 ms for 64 points."""
        points, count_ = array(Vec3, points)
        shape = Shape()
        check(lib().hh_shape_add_hull(self._handle, points, count_, byref(shape)))
        return shape

    def shape_add_compound(self, parts):
        """1 to 64 parts that move as one. It keeps copies: the parts may be removed. Cost with fits_hands: as if
        all its parts were new shapes."""
        parts, count_ = array(CompoundPart, parts)
        shape = Shape()
        check(lib().hh_shape_add_compound(self._handle, parts, count_, byref(shape)))
        return shape

    def shape_add_mesh(self, mesh, scale):
        """A shape of a prepared mesh, for static and kinematic bodies. The size of each factor is in [1e-3,
        1e3], others get HH_ERROR_VALUE; negative ones mirror the mesh, whose triangles keep their outer side.
        Cost: microseconds for scale 1; another scale prepares the hands' surface again, about 40 microseconds
        a triangle with fits_hands."""
        shape = Shape()
        check(lib().hh_shape_add_mesh(self._handle, handle(mesh), value(Vec3, scale), byref(shape)))
        return shape

    def shape_remove(self, shape):
        """HH_ERROR_STATE while a body or a player has the shape."""
        check(lib().hh_shape_remove(self._handle, value(Shape, shape)))

    def shape_is_valid(self, shape):
        return bool(lib().hh_shape_is_valid(self._handle, value(Shape, shape)))

    def shape_count(self):
        """Number of shapes."""
        count = c_size_t()
        check(lib().hh_world_shape_count(self._handle, byref(count)))
        return count.value

    def body_add(self, definition=None, **fields):
        """Adds a body. Cost: constant, whatever else is in the world."""
        body = Body()
        check(lib().hh_body_add(self._handle, optional(BodyDef, definition, fields), byref(body)))
        return body

    def body_remove(self, body):
        """Removes a body with its joints. Hands that grip it are empty at once; the event follows in the next
        step."""
        check(lib().hh_body_remove(self._handle, value(Body, body)))

    def body_is_valid(self, body):
        return bool(lib().hh_body_is_valid(self._handle, value(Body, body)))

    def body_find(self, name):
        body = Body()
        check(lib().hh_body_find(self._handle, text(name), byref(body)))
        return body

    def body_name(self, body):
        """Valid until a body is added or removed. Empty if the name came only with a snapshot."""
        name = c_char_p()
        check(lib().hh_body_name(self._handle, value(Body, body), byref(name)))
        return shown(name.value)

    def bodies(self):
        """Ids of all bodies; `count` gets their number. HH_ERROR_CAPACITY if it is more than `capacity`. A null
        buffer of capacity 0: the number only."""
        return listed(Body, lambda buffer, capacity, count: lib().hh_world_bodies(self._handle, buffer, capacity, count))

    def body_pose(self, body):
        pose = Pose()
        check(lib().hh_body_pose(self._handle, value(Body, body), byref(pose)))
        return pose

    def body_poses(self, bodies):
        """Poses of many bodies in one call; HH_ERROR_HANDLE, and nothing written, if one is stale."""
        bodies, count_ = array(Body, bodies)
        poses, poses_at = empty(Pose, count_)
        check(lib().hh_world_body_poses(self._handle, bodies, count_, poses_at))
        return poses

    def body_velocity(self, body):
        """Null outputs are skipped."""
        velocity_mps = Vec3()
        angular_velocity_radps = Vec3()
        check(lib().hh_body_velocity(self._handle, value(Body, body), byref(velocity_mps), byref(angular_velocity_radps)))
        return velocity_mps, angular_velocity_radps

    def body_set_velocity(self, body, velocity_mps, angular_velocity_radps):
        """Within 1e6 m/s and 1e4 rad/s. HH_ERROR_STATE for a body that is not dynamic."""
        check(lib().hh_body_set_velocity(self._handle, value(Body, body), value(Vec3, velocity_mps), value(Vec3, angular_velocity_radps)))

    def body_apply_impulse(self, body, impulse_ns, point):
        """Changes the velocity by an impulse in N s at a point in the world. HH_ERROR_STATE for a body that is
        not dynamic, HH_ERROR_VALUE if the velocity would leave the limits of hh_body_set_velocity."""
        check(lib().hh_body_apply_impulse(self._handle, value(Body, body), value(Vec3, impulse_ns), value(Vec3, point)))

    def body_teleport(self, body, pose):
        """Moves a body at once, without collisions on the path. It keeps its velocity; hands that grip it let
        go."""
        check(lib().hh_body_teleport(self._handle, value(Body, body), value(Pose, pose)))

    def body_move_kinematic(self, body, pose):
        """A kinematic body reaches the pose at the end of the next step and then rests. Call it before every
        step in which it moves, or less often: a host that ticks slower than it draws may tell each tick's
        pose once. The body's velocity, with which hands leave it and bodies are thrown, is the displacement
        since the pose before over the time since then; over tracking.release_window_s if the poses come at
        varying times. It is 0 once a pose is due that does not come or is the same. The first pose after a
        rest counts as half a second's motion, since nothing says when it began."""
        check(lib().hh_body_move_kinematic(self._handle, value(Body, body), value(Pose, pose)))

    def body_set_gravity_scale(self, body, scale):
        check(lib().hh_body_set_gravity_scale(self._handle, value(Body, body), scale))

    def body_set_layers(self, body, layers, mask):
        check(lib().hh_body_set_layers(self._handle, value(Body, body), layers, mask))

    def body_set_grab_rule(self, body, left, right, two_hands, priority):
        check(lib().hh_body_set_grab_rule(self._handle, value(Body, body), left, right, two_hands, priority))

    def body_get_kind(self, body):
        kind = c_int32()
        check(lib().hh_body_get_kind(self._handle, value(Body, body), byref(kind)))
        return kind.value

    def body_mass(self, body):
        """0 for a body that is not dynamic: nothing that acts on it moves it."""
        mass_kg = c_double()
        check(lib().hh_body_mass(self._handle, value(Body, body), byref(mass_kg)))
        return mass_kg.value

    def body_set_mass(self, body, mass_kg, inertia_kgm2):
        """Mass in [1e-12, 1e15] kg and inertia as hh_body_def's, else HH_ERROR_VALUE; 0 inertia: of the solid
        shape. Dynamic bodies only: HH_ERROR_STATE. Hands keep their grips: beyond phases.heavy_body_kg the
        body moves its player from the next step on, below it comes along."""
        check(lib().hh_body_set_mass(self._handle, value(Body, body), mass_kg, value(Vec3, inertia_kgm2)))

    def body_material(self, body):
        """Friction in [0, 1e6], restitution in [0, 1]. Null outputs are skipped."""
        friction = c_double()
        restitution = c_double()
        check(lib().hh_body_material(self._handle, value(Body, body), byref(friction), byref(restitution)))
        return friction.value, restitution.value

    def body_set_material(self, body, friction, restitution):
        check(lib().hh_body_set_material(self._handle, value(Body, body), friction, restitution))

    def body_set_kind(self, body, kind, mass_kg, inertia_kgm2):
        """A body becomes static, kinematic or dynamic where it is. Hands keep their grips without a jump: a body
        that becomes dynamic comes along, others move the player. A body that becomes static or kinematic
        stops; one that becomes dynamic keeps its velocity. Joints stay. Mass and inertia: of a body that
        becomes dynamic, as hh_body_set_mass; of others ignored. A mesh cannot become dynamic: HH_ERROR_VALUE.
        HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step."""
        check(lib().hh_body_set_kind(self._handle, value(Body, body), kind, mass_kg, value(Vec3, inertia_kgm2)))

    def body_shape(self, body):
        """Null for a body without a shape."""
        shape = Shape()
        check(lib().hh_body_shape(self._handle, value(Body, body), byref(shape)))
        return shape

    def body_set_shape(self, body, shape):
        """The body touches with another shape from now on, or with none (null id). A dynamic body needs a solid
        shape: HH_ERROR_VALUE for none or a mesh. The body's pose, joints and grips stay as they are in the
        frame in which the host made the shapes, whatever their centres of mass; a dynamic body's inertia
        becomes that of the solid shape with the same mass. Hands let go in the next step (HH_EVENT_RELEASED,
        HH_REASON_BY_HOST) if the body has no shape any more, or if their palm is farther from the new surface
        than a closing hand reaches: hand.ray_length_m minus hand.ray_back_m, or hand.reach_m if that is
        larger. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; with a
        mesh that a hand grips, linear in its triangles, 0.1 ms for 5,000."""
        check(lib().hh_body_set_shape(self._handle, value(Body, body), value(Shape, shape)))

    def body_set_user_data(self, body, user_data):
        check(lib().hh_body_set_user_data(self._handle, value(Body, body), user_data))

    def body_user_data(self, body):
        user_data = c_uint64()
        check(lib().hh_body_user_data(self._handle, value(Body, body), byref(user_data)))
        return user_data.value

    def add_gltf_level(self, gltf, pose):
        """Adds a level from the bytes of a glTF file (.glb, or .gltf with its data inside): a static body with a
        mesh for each node that has triangles, where the file has them, moved by `pose`. Its name is the
        node's, with a number if the world has that name. `bodies` may be null; `count` gets their number.
        HH_ERROR_CAPACITY and HH_ERROR_DATA, which says what the file lacks: nothing is added. Cost: that of
        hh_mesh_create for every triangle."""
        gltf, size_ = raw(gltf)
        return listed(Body, lambda buffer, capacity, count: lib().hh_world_add_gltf_level(self._handle, gltf, size_, value(Pose, pose), buffer, capacity, count))

    def joint_add(self, definition=None, **fields):
        joint = Joint()
        check(lib().hh_joint_add(self._handle, optional(JointDef, definition, fields), byref(joint)))
        return joint

    def joint_remove(self, joint):
        check(lib().hh_joint_remove(self._handle, value(Joint, joint)))

    def joint_is_valid(self, joint):
        return bool(lib().hh_joint_is_valid(self._handle, value(Joint, joint)))

    def body_joints(self, body):
        """Ids of the joints of a body; `count` gets their number. HH_ERROR_CAPACITY if it is more than
        `capacity`. A null buffer of capacity 0: the number only."""
        return listed(Joint, lambda buffer, capacity, count: lib().hh_body_joints(self._handle, value(Body, body), buffer, capacity, count))

    def joint_set_motor(self, joint, definition=None, **fields):
        """Drives a hinge or slider from the next step on, with a limited force, as friction acts; replaces its
        detents. A position's target moves a stiff drive: a load below the strength does not deflect it. Part
        of the state. HH_ERROR_VALUE for other kinds of joints. Cost: that of a joint with friction."""
        check(lib().hh_joint_set_motor(self._handle, value(Joint, joint), optional(MotorDef, definition, fields)))

    def joint_set_limits(self, joint, limited, lower, upper):
        """New limits of the coordinate, as in hh_joint_def; equal ones lock the joint there. A joint beyond them
        is moved within. Bodies move at once: hands that held on may slip."""
        check(lib().hh_joint_set_limits(self._handle, value(Joint, joint), limited, lower, upper))

    def joint_set_latch(self, joint, at, range, strength):
        """A new latch, as in hh_joint_def; range 0: none. The handle stays. A closed latch stays closed if it is
        at the same place."""
        check(lib().hh_joint_set_latch(self._handle, value(Joint, joint), at, range, strength))

    def joint_set_friction(self, joint, friction):
        check(lib().hh_joint_set_friction(self._handle, value(Joint, joint), friction))

    def joint_state(self, joint):
        """State after the last step; null outputs are skipped. A hinge counts full turns."""
        coordinate = c_double()
        speed = c_double()
        latched = c_uint8()
        check(lib().hh_joint_state(self._handle, value(Joint, joint), byref(coordinate), byref(speed), byref(latched)))
        return coordinate.value, speed.value, bool(latched.value)

    def contacts(self):
        """The contacts of the last step, in a fixed order: pairs that have come within 0.1 mm, or between which
        an impulse acted. Empty after a restore and after hh_world_step_simulated. `count` gets their number;
        HH_ERROR_CAPACITY if it is more than `capacity`."""
        return listed(Contact, lambda buffer, capacity, count: lib().hh_world_contacts(self._handle, buffer, capacity, count))

    def cast_ray(self, start, end, skip):
        """First surface that the segment hits, from outside or inside; distance_m: from `from`. `skip`: a player
        whose head counts as not there; null: none. Coordinates within 1e9 m."""
        hit = Hit()
        check(lib().hh_world_cast_ray(self._handle, value(Vec3, start), value(Vec3, end), value(Player, skip), byref(hit)))
        return hit

    def cast_sphere(self, radius_m, start, end, skip):
        """First impact of a sphere that moves along the segment. Radius in [1e-6, 1e4] m; distance_m: how far
        its centre has moved, 0 if it touches something at the start."""
        hit = Hit()
        check(lib().hh_world_cast_sphere(self._handle, radius_m, value(Vec3, start), value(Vec3, end), value(Player, skip), byref(hit)))
        return hit

    def closest_point(self, point, max_distance_m, skip):
        """Nearest surface point within max_distance_m of the point, [0, 1e4]; distance_m: 0 inside a solid,
        where the normal points outward."""
        hit = Hit()
        check(lib().hh_world_closest_point(self._handle, value(Vec3, point), max_distance_m, value(Player, skip), byref(hit)))
        return hit

    def overlap_sphere(self, center, radius_m, skip):
        """Everything that a sphere touches: the nearest point of each body and head to its centre, in a fixed
        order. Inside a solid distance_m is 0 and the normal points outward. `count` gets their number;
        HH_ERROR_CAPACITY if it is more than `capacity`. Radius in [0, 1e4] m."""
        return listed(Hit, lambda buffer, capacity, count: lib().hh_world_overlap_sphere(self._handle, value(Vec3, center), radius_m, value(Player, skip), buffer, capacity, count))

    def player_add(self, definition=None, **fields):
        player = Player()
        check(lib().hh_player_add(self._handle, optional(PlayerDef, definition, fields), byref(player)))
        return player

    def player_remove(self, player):
        check(lib().hh_player_remove(self._handle, value(Player, player)))

    def player_is_valid(self, player):
        return bool(lib().hh_player_is_valid(self._handle, value(Player, player)))

    def players(self):
        return listed(Player, lambda buffer, capacity, count: lib().hh_world_players(self._handle, buffer, capacity, count))

    def player_recenter(self, player, new_in_old):
        """The headset's runtime, or the host, has recentred: from the next sample on, poses are given in a space
        that lies at `new_in_old` in the space before (OpenXR: poseInPreviousSpace). It turns about +Y only,
        else HH_ERROR_VALUE: x and z of the quaternion within 0.001. Before the player's first sample there is
        nothing to recentre. View, hands and grips stay where they are in the world; hh_player_pose.origin
        changes at once, HH_EVENT_RECENTRED follows in the next step. From now on the host announces all
        recentrings, as after hh_player_set_recenter_guess(world, player, 0)."""
        check(lib().hh_player_recenter(self._handle, value(Player, player), value(Pose, new_in_old)))

    def player_set_recenter_guess(self, player, guesses):
        """`guesses` 1, the default: if head and hands jump by one turn about +Y and one translation, or the head
        by more than tracking.max_jump_m, the runtime has recentred, and nothing in the world moves. 0: the
        host announces recentrings, and every other jump is meant, such as a turn that the host puts into its
        samples: view and hands follow it, and gripping hands take new anchors. Part of the state."""
        check(lib().hh_player_set_recenter_guess(self._handle, value(Player, player), guesses))

    def player_teleport(self, player, origin):
        """Moves the play space at once; it is then at rest relative to the scene. Dynamic bodies in the hands
        that no joint holds come along; hands let go of everything else, and hands of other players let go of
        this player and of those bodies."""
        check(lib().hh_player_teleport(self._handle, value(Player, player), value(Pose, origin)))

    def player_velocity(self, player):
        velocity_mps = Vec3()
        check(lib().hh_player_velocity(self._handle, value(Player, player), byref(velocity_mps)))
        return velocity_mps

    def player_set_velocity(self, player, velocity_mps):
        check(lib().hh_player_set_velocity(self._handle, value(Player, player), value(Vec3, velocity_mps)))

    def player_reference_velocity(self, player):
        """The velocity that counts as rest for the player: that of the body last gripped, at the gripped point,
        else the scene's. A player feels the speed relative to it: for vignettes and wind."""
        velocity_mps = Vec3()
        check(lib().hh_player_reference_velocity(self._handle, value(Player, player), byref(velocity_mps)))
        return velocity_mps

    def player_push_back(self, player):
        """How far contacts moved the play space in the last step, against its hands and its velocity."""
        distance_m = c_double()
        check(lib().hh_player_push_back(self._handle, value(Player, player), byref(distance_m)))
        return distance_m.value

    def player_mass(self, player):
        """hh_player_def.mass_kg."""
        mass_kg = c_double()
        check(lib().hh_player_mass(self._handle, value(Player, player), byref(mass_kg)))
        return mass_kg.value

    def player_head(self, player):
        """The sphere with which the head collides, in the world. Null outputs are skipped. is_tracked: false
        before the head's first sample, and while it is lost or inferred."""
        center = Vec3()
        radius_m = c_double()
        is_tracked = c_uint8()
        check(lib().hh_player_head(self._handle, value(Player, player), byref(center), byref(radius_m), byref(is_tracked)))
        return center, radius_m.value, bool(is_tracked.value)

    def player_measures(self, player):
        """The measures times the player's scale, in the world's metres: those given or measured in a T-pose,
        else what is believed of the player's size by now."""
        measures = Measures()
        check(lib().hh_player_measures(self._handle, value(Player, player), byref(measures)))
        return measures

    def player_set_measures(self, player, measures):
        """Replaces the measures, which are then no longer estimated. `measures`, not null: times the player's
        scale, each in [0.05, 5] m times the scale."""
        check(lib().hh_player_set_measures(self._handle, value(Player, player), byref(value(Measures, measures))))

    def player_set_user_data(self, player, user_data):
        check(lib().hh_player_set_user_data(self._handle, value(Player, player), user_data))

    def player_user_data(self, player):
        user_data = c_uint64()
        check(lib().hh_player_user_data(self._handle, value(Player, player), byref(user_data)))
        return user_data.value

    def player_set_hand_in_controller(self, player, side, hand_in_controller=None):
        """Sets the hand's wrist in the frame of hh_tracking_sample.hands: identity if the samples are wrists
        with OpenXR's axes (-Z to the fingers, +Y the back of the hand). The pose is in the world's metres,
        like the samples, and does not scale with the player; within 10 m. Null: the default, which is the
        tuning's hand.controller_ numbers, for a controller's grip pose, times the player's scale."""
        check(lib().hh_player_set_hand_in_controller(self._handle, value(Player, player), side, optional(Pose, hand_in_controller)))

    def player_hand_in_controller(self, player, side):
        """Returns the wrist in the frame of the player's samples, in the world's metres: the pose set by
        hh_player_set_hand_in_controller or, without one, the tuning's times the player's scale. For hosts
        that have wrists and need controllers."""
        hand_in_controller = Pose()
        check(lib().hh_player_hand_in_controller(self._handle, value(Player, player), side, byref(hand_in_controller)))
        return hand_in_controller

    def hand_in_controller(self, side):
        """Returns the tuning's pose of the wrist in a controller. Players of scale 1 without a pose of their own
        have it."""
        hand_in_controller = Pose()
        check(lib().hh_world_hand_in_controller(self._handle, side, byref(hand_in_controller)))
        return hand_in_controller

    def player_hand(self, player, side):
        """One hand. `hand_size`: bytes of hh_hand_state as the host knows it."""
        hand = HandState()
        check(lib().hh_player_hand_sized(self._handle, value(Player, player), side, byref(hand), sizeof(HandState)))
        return hand

    def hand_moves_player(self, player, side):
        """True if the player can pull on what the hand grips: something static, kinematic or heavy, another
        player, or a body that joints connect to something fixed, such as a lever. False if the hand is empty,
        or what it holds comes along."""
        moves_player = c_uint8()
        check(lib().hh_hand_moves_player(self._handle, value(Player, player), side, byref(moves_player)))
        return bool(moves_player.value)

    def player_poses(self, players):
        """Poses of many players in one call; HH_ERROR_HANDLE, and nothing written, if one is stale. `pose_size`,
        `hand_size`: bytes of hh_player_pose and hh_hand_state as the host knows them."""
        players, count_ = array(Player, players)
        poses, poses_at = empty(PlayerPose, count_)
        check(lib().hh_world_player_poses_sized(self._handle, players, count_, poses_at, sizeof(PlayerPose), sizeof(HandState)))
        return poses

    def hand_grip(self, player, side, body):
        """In the next step the hand grips `body` where both are, at any distance, whatever the grab rules say;
        only a body for two hands needs an order for both. No grip begins while the player opens the hand. It
        holds until hh_hand_release or until the player opens the hand. If the player closes the hand before
        that, it grips what is in reach instead; with nothing in reach, the grip stays. HH_ERROR_STATE for a
        hand that was never tracked."""
        check(lib().hh_hand_grip(self._handle, value(Player, player), side, value(Body, body)))

    def hand_release(self, player, side):
        """In the next step the hand lets go, without a throw. It grips again when the player opens and closes
        it. HH_OK also for an empty hand."""
        check(lib().hh_hand_release(self._handle, value(Player, player), side))

    def events(self):
        """The events of the last step, in a fixed order. Valid until the next step, restore, destroy or call of
        this function. `event_size`: bytes of hh_event as the host knows it; the list's elements lie so far
        apart."""
        events = POINTER(Event)()
        count = c_size_t()
        check(lib().hh_world_events_sized(self._handle, byref(events), byref(count), sizeof(Event)))
        return copied(Event, events, count)

    def player_hand_joints(self, player, side, space):
        """The shown hand's joints. `joints`: HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name."""
        joints, joints_at = empty(HandJoint, 26)
        check(lib().hh_player_hand_joints(self._handle, value(Player, player), side, space, joints_at))
        return joints

    def player_body_joints(self, player, space):
        """`joints`: HH_BODY_JOINT_COUNT elements."""
        joints, joints_at = empty(Pose, 20)
        check(lib().hh_player_body_joints(self._handle, value(Player, player), space, joints_at))
        return joints

    def player_set_hand_rig(self, player, side, gltf):
        """The player's hand gets the proportions of the skeleton in a glTF file (.glb, or .gltf with its data
        inside) whose joints have WebXR's or OpenXR's names. Null bytes: the built-in hand. HH_ERROR_DATA says
        what the file lacks."""
        gltf, size_ = raw(gltf)
        check(lib().hh_player_set_hand_rig(self._handle, value(Player, player), side, gltf, size_))

    def player_set_body_rig(self, player, gltf):
        """The player's body drives a humanoid skeleton from a glTF file; the table of a VRM file says which
        joint is which. Null bytes: none."""
        gltf, size_ = raw(gltf)
        check(lib().hh_player_set_body_rig(self._handle, value(Player, player), gltf, size_))

    def player_set_body_skeleton(self, player, joints, space):
        """hh_player_set_body_rig for a skeleton as an array, of an engine that has no glTF file: 1 to 1024
        joints, in any order. In other axes: handhold/convert.h. No joints: none. The tracked head lies
        between the eyes: at joints below the head whose names end in "eye", "eyes", "eye_l", "eye_r", "eye.l"
        or "eye.r", in any case, else estimated from the head's joint and its children. HH_ERROR_VALUE for
        parents that do not exist or form a ring; HH_ERROR_DATA says by name or index which joints are missing
        or implausible."""
        joints, count_ = array(SkeletonJoint, joints)
        check(lib().hh_player_set_body_skeleton(self._handle, value(Player, player), joints, count_, space))

    def player_skeleton(self, player, space):
        """Joints of the player's body rig, in the order in which they were given. Fingers follow the shown
        hand's; a figure with both hands' fingers needs no second pair of hands (hh_player_skeleton_fingers).
        HH_ERROR_STATE without a rig."""
        return listed(Pose, lambda buffer, capacity, count: lib().hh_player_skeleton(self._handle, value(Player, player), space, buffer, capacity, count))

    def player_skeleton_joint(self, player, joint):
        """Name and parent (-1: none) of one of these joints. The name is valid while the rig is set."""
        name = c_char_p()
        parent = c_int32()
        check(lib().hh_player_skeleton_joint(self._handle, value(Player, player), joint, byref(name), byref(parent)))
        return shown(name.value), parent.value

    def player_skeleton_fingers(self, player, side):
        """Number of fingers of a hand of the body rig that follow the shown hand's, 0 to 5: 0 is a figure whose
        hands the host draws by hh_player_hand_joints."""
        count = c_size_t()
        check(lib().hh_player_skeleton_fingers(self._handle, value(Player, player), side, byref(count)))
        return count.value

    def body_add_grip(self, body, definition=None, **fields):
        """Adds an authored grip to a body: hands that close near it take it. HH_ERROR_STATE if the body has 4
        already."""
        check(lib().hh_body_add_grip(self._handle, value(Body, body), optional(GripDef, definition, fields)))

    def set_surface_query(self, query=None):
        """From now on hands, trunks and legs ask the host, not the world's shapes. Null: back to the shapes.
        HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step."""
        query = held(SurfaceQuery, query)
        check(lib().hh_world_set_surface_query(self._handle, optional(SurfaceQuery, query)))
        self._kept["hh_surface_query"] = query

    def body_set_surface(self, body, mesh):
        """The triangles that palm and fingers close on, in the body's frame; null: none. Not needed for
        gripping. The body must have no shape. HH_ERROR_STATE if it has, or if the mesh or the world was made
        without fits_hands."""
        check(lib().hh_body_set_surface(self._handle, value(Body, body), handle(mesh)))

    def place_bodies(self, motions):
        """Where bodies are now, after the host's own step. Unlike a teleport it ends no grip. A kinematic body
        rests there until hh_body_move_kinematic says where it will be at the end of the next step. Places all
        or, on an error, none. HH_ERROR_VALUE for a body that is there twice."""
        motions, count_ = array(BodyMotion, motions)
        check(lib().hh_world_place_bodies(self._handle, motions, count_))

    def player_place(self, player, origin, velocity_mps):
        """Where a player's hh_player_pose.origin is now, and its velocity, by the host's locomotion. Unlike a
        teleport it ends no grip."""
        check(lib().hh_player_place(self._handle, value(Player, player), value(Pose, origin), value(Vec3, velocity_mps)))

    def hand_hold(self, player, side, body, anchor=None):
        """The hand holds `body` from now on; a null id: nothing. `anchor`: the wrist in the body's frame; null:
        where both are now, HH_ERROR_STATE for a hand that was never tracked. For hosts that use
        hh_world_step_hands only: the other steps keep the hold and let the hand pull the player."""
        check(lib().hh_hand_hold(self._handle, value(Player, player), side, value(Body, body), optional(Pose, anchor)))

    def hand_find_grip(self, player, side):
        """What the hand would grip if it closed where it is, by the rules of hands that pull players: reach,
        sight, grab rules, authored grips. A null body: nothing, or another player. distance_m: from the palm.
        In every kind of world. HH_ERROR_STATE for a hand that was never tracked."""
        hit = SurfaceHit()
        check(lib().hh_hand_find_grip(self._handle, value(Player, player), side, byref(hit)))
        return hit

    def step_hands(self, dt_s, inputs):
        """One frame: reads tracking and shows hands and bodies where the host put them. It moves neither players
        nor bodies, and buttons do nothing: place bodies by hh_world_place_bodies. A move ordered by
        hh_body_move_kinematic waits for the next step of another kind. Cost: that of hh_world_step without
        physics."""
        inputs, input_count_ = array(PlayerInput, inputs)
        check(lib().hh_world_step_hands(self._handle, dt_s, inputs, input_count_))

    def begin_step(self, dt_s, inputs):
        """First half of a step: tracking, grips and constraints. Bodies must be placed where they are. Until
        hh_world_end_step, HH_ERROR_STATE for adding or removing bodies, joints and players, for teleporting,
        saving and other steps; hh_world_restore forgets the begun step."""
        inputs, input_count_ = array(PlayerInput, inputs)
        check(lib().hh_world_begin_step(self._handle, dt_s, inputs, input_count_))

    def hand_constraints(self):
        """Constraints of the begun step: at most one per hand, in the order in which hands were added. Valid
        until hh_world_end_step."""
        constraints = POINTER(HandConstraint)()
        count = c_size_t()
        check(lib().hh_world_hand_constraints(self._handle, byref(constraints), byref(count)))
        return copied(HandConstraint, constraints, count)

    def player_motions(self):
        """One entry per player, in the order of hh_world_players. Valid until hh_world_end_step."""
        motions = POINTER(PlayerMotion)()
        count = c_size_t()
        check(lib().hh_world_player_motions(self._handle, byref(motions), byref(count)))
        return copied(PlayerMotion, motions, count)

    def end_step(self, players):
        """Second half, after the host's solver. `players`: the solved play spaces; one left out moves as
        predicted, HH_ERROR_VALUE for one that is there twice. Bodies that the host has not placed since
        hh_world_begin_step rest where they were. Releases grips, limits velocities and shows hands and
        bodies. On an error the step stays begun."""
        players, count_ = array(SolvedPlayer, players)
        check(lib().hh_world_end_step(self._handle, players, count_))

    def velocity_changes(self):
        """Velocities that the host must give its bodies: after hh_world_begin_step those of bodies that the
        distance grab pulls, after hh_world_end_step those of thrown and limited bodies. Players':
        hh_player_velocity. Valid until the next step."""
        changes = POINTER(VelocityChange)()
        count = c_size_t()
        check(lib().hh_world_velocity_changes(self._handle, byref(changes), byref(count)))
        return copied(VelocityChange, changes, count)

    def held_bodies(self):
        """After hh_world_step: dynamic bodies that hands hold, and those that joints connect to them. The host
        makes its own kinematic, takes pose and velocity from here, and places all others before the next
        step. They touch nothing of the host's, but push what its solver pushes."""
        return listed(Body, lambda buffer, capacity, count: lib().hh_world_held_bodies(self._handle, buffer, capacity, count))


class MatchCalls:
    """Every function of a match, as a method. Calls that the library refuses raise HandholdError and change nothing. What a game's function raises is raised
    when the call has ended, which still takes effect."""

    _handle = None

    def ticks_due(self, elapsed_s):
        """How often to call hh_match_advance for so much time of the local clock since the last call, [0, 8]: a
        little more or less than its share, so that inputs reach the server just before they are needed. A
        spectator stays 9 ticks behind what has come."""
        ticks = c_uint32()
        check(lib().hh_match_ticks_due(self._handle, elapsed_s, byref(ticks)))
        return ticks.value

    def advance(self, input):
        """Goes back to the first wrong guess, if there is one, steps again to the present, and then one tick on.
        `input`, not null. `advanced` gets false, and the input is dropped, while the world is 62 ticks ahead
        of the last confirmed tick. Each tick stepped again costs about a quarter of a shown step:
        docs/reference/matches.md has figures. A spectator steps the next confirmed tick, or gets false if its
        inputs have not come; of `input` it takes only is_hidden."""
        advanced = c_uint8()
        check(lib().hh_match_advance(self._handle, byref(value(MatchInput, input)), byref(advanced)))
        return bool(advanced.value)

    def receive(self, packet):
        """Takes a packet of the server; a spectator those of hh_match_confirmed_inputs. HH_ERROR_DATA, and no
        change, for bytes that are damaged or not of this match. Packets that came too late or out of order
        are HH_OK: what they lack comes again. Both are counted in hh_match_stats.refused. Tolerates any
        bytes."""
        packet, size_ = raw(packet)
        check(lib().hh_match_receive(self._handle, packet, size_))

    def packet(self):
        """Clients only. Writes the next packet to the server, `size` bytes. Call once a tick or once in two. A
        null `buffer` asks for the most bytes that a packet has, HH_MATCH_PACKET_BYTES; HH_ERROR_CAPACITY for
        a smaller `capacity`."""
        return listed(c_uint8, lambda buffer, capacity, count: lib().hh_match_packet(self._handle, buffer, capacity, count))

    def join(self, bytes):
        """Replaces the world's state by the one of hh_match_state, over a reliable stream of yours. Set your own
        state to the server's of the same tick before the next hh_match_advance. HH_ERROR_DATA, and no change,
        for other bytes. Tolerates any bytes."""
        bytes, size_ = raw(bytes)
        check(lib().hh_match_join(self._handle, bytes, size_))

    def connect(self, slot):
        """Somebody plays the slot, or nobody does: then its hands let go and its body floats. At first nobody
        plays any slot."""
        check(lib().hh_match_connect(self._handle, slot))

    def disconnect(self, slot):
        check(lib().hh_match_disconnect(self._handle, slot))

    def receive_from(self, slot, now_s, packet):
        """Takes a packet that came from that slot's player, at `now_s` on the server's clock. As
        hh_match_receive; a packet of another slot is HH_ERROR_DATA. The checksum in it finds damage, not
        forgery: your transport authenticates."""
        packet, size_ = raw(packet)
        check(lib().hh_match_receive_from(self._handle, slot, now_s, packet, size_))

    def confirm(self, now_s):
        """Confirms and steps the ticks whose inputs are complete, or which have ended on the server's clock;
        missing inputs are filled by a guess that all machines share. At most 16 a call; `ticks` gets the
        number. Call several times a tick. Null output: skipped."""
        ticks = c_uint32()
        check(lib().hh_match_confirm(self._handle, now_s, byref(ticks)))
        return ticks.value

    def packet_to(self, slot):
        """Writes the next packet to that slot's player. As hh_match_packet."""
        return listed(c_uint8, lambda buffer, capacity, count: lib().hh_match_packet_to(self._handle, slot, buffer, capacity, count))

    def state(self, slot):
        """Writes the state that a player joins with, `size` bytes, for hh_match_join; send your own state of
        this tick with it. From now on the player is sent the inputs after it. As hh_world_save; with a null
        `buffer` nothing changes. HH_MATCH_NO_SLOT: the state for a spectator, who is sent the confirmed
        inputs after the present tick."""
        return listed(c_uint8, lambda buffer, capacity, count: lib().hh_match_state(self._handle, slot, buffer, capacity, count))

    def sync_test(self, inputs):
        """Steps one tick with an input for each slot, then goes back sync_ticks and steps again."""
        inputs, input_count_ = array(MatchInput, inputs)
        difference = MatchDifference()
        check(lib().hh_match_sync_test(self._handle, inputs, input_count_, byref(difference)))
        return difference

    def confirmed_inputs(self, after):
        """Writes the inputs of all slots in the confirmed ticks after `after`, for hh_match_receive of
        spectators: over a reliable stream of yours, or into a file, which then has the whole match. `until`
        gets the last tick written, `after` if there is nothing new: 128 ticks at most, and fewer if the
        buffer is full. Every 90th tick carries its hash, which the reader compares. HH_ERROR_VALUE if `after`
        is later than the last confirmed tick, or too early: 320 ticks are always kept, at most 448. A
        spectator then needs a state. A null `buffer` asks for HH_MATCH_INPUTS_BYTES; HH_ERROR_CAPACITY for
        less."""
        until = c_uint64()
        return listed(c_uint8, lambda buffer, capacity, count: lib().hh_match_confirmed_inputs(self._handle, after, buffer, capacity, count, byref(until))), until.value

    def needs_state(self, slot):
        """A player needs hh_match_state and hh_match_join: the world differs from the server's, or inputs are
        lost for good. A client answers for its own slot only, a spectator for any."""
        needs = c_uint8()
        check(lib().hh_match_needs_state(self._handle, slot, byref(needs)))
        return bool(needs.value)

    def hash(self, tick):
        """Hash of world and game after a tick: equal on all machines if the tick is confirmed. HH_ERROR_VALUE
        unless it is the present one or, on a client, one of the 63 before that it has stepped."""
        hash = c_uint64()
        check(lib().hh_match_hash(self._handle, tick, byref(hash)))
        return hash.value

    def shown_offsets(self, slot):
        """Add these to the drawn positions of a slot's player, so that a corrected guess moves them within 0.08
        s and not at once: to head and body, and to each hand with what it holds. m, world axes. For the own
        slot `head` is for the view too, with hands that hold nothing: it moves when others pull at what you
        hold. Only for pictures. Zero for servers, spectators and sync tests."""
        head = Vec3()
        left = Vec3()
        right = Vec3()
        check(lib().hh_match_shown_offsets(self._handle, slot, byref(head), byref(left), byref(right)))
        return head, left, right

    def drawn_player(self, slot, newest=None):
        """Where to draw a slot's player between two ticks, for displays of another rate than the tick's: at the
        time up to which hh_match_ticks_due has been called, less one tick, which lies between the last two
        shown ticks. Call after the ticks of a picture. With hh_match_shown_offsets already. World poses:
        `origin` is the space of the samples, for the camera rig; `head`; and wrists to draw. A play space
        that moves by more than 0.5 m or turns by more than 0.2 rad at once, as by a teleport or a snap turn,
        is not drawn in between. While the world waits, everything stands still. `newest`, for the own slot:
        the devices at the time of the picture, of any time_s. Head and empty hands are then drawn where they
        are, and not late. Null: between ticks, as everything else. Fingers go with their wrist; arms, spine
        and legs with the head. Never changes the world. HH_ERROR_VALUE if `newest` is given for another slot,
        or to a spectator. Clients and spectators. HH_ERROR_STATE before the first shown tick, and after
        hh_match_join."""
        origin = Pose()
        head = Pose()
        left = Pose()
        right = Pose()
        check(lib().hh_match_drawn_player(self._handle, slot, optional(TrackingSample, newest), byref(origin), byref(head), byref(left), byref(right)))
        return origin, head, left, right

    def drawn_bodies(self, bodies):
        """The same for bodies: poses as of hh_world_body_poses. A body that is held goes with its hands; one
        that moves by more than 0.5 m at once is not drawn in between."""
        bodies, count_ = array(Body, bodies)
        poses, poses_at = empty(Pose, count_)
        check(lib().hh_match_drawn_bodies(self._handle, bodies, count_, poses_at))
        return poses

    def events(self):
        """What the last hh_match_advance, hh_match_confirm, hh_match_join or hh_match_sync_test found, in the
        order of finding. Servers and sync tests have confirmed events only. Valid until the next call of
        these or of this function. `event_size`: bytes of hh_match_event as the host knows it; the list's
        elements lie so far apart."""
        events = POINTER(MatchEvent)()
        count = c_size_t()
        check(lib().hh_match_events_sized(self._handle, byref(events), byref(count), sizeof(MatchEvent)))
        return copied(MatchEvent, events, count)

    def get_stats(self):
        stats = MatchStats()
        check(lib().hh_match_get_stats(self._handle, byref(stats)))
        return stats
