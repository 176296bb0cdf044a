// Made from the C headers by systems/host/bindings/generate.py; do not edit.

/** Fields that are left out keep the library's defaults, also inside of structs. Vectors and rotations are given whole. null is no id. */
export type Given<T> = T extends (...words: never[]) => unknown ? T : T extends (infer One)[] ? Given<One>[]
    : T extends hh_vec3 | hh_quat ? T : T extends { index: number; generation: number } ? T | null
    : T extends object ? { [Field in keyof T]?: Given<T[Field]> } : T;

/** A mesh made by Handhold.createMesh. */
export type Mesh = number & { readonly mesh: unique symbol };

export declare const HANDHOLD_VERSION_MAJOR: 0;
export declare const HANDHOLD_VERSION_MINOR: 2;
export declare const HANDHOLD_VERSION_PATCH: 0;
export declare const HANDHOLD_VERSION_TEXT: "0.2.0";
export declare const HH_HAND_JOINT_COUNT: 26;
export declare const HH_IS_BY_NAME: 0;
export declare const HH_IS_BODY: 100;
export declare const HH_IS_LEFT_HAND: 200;
export declare const HH_IS_RIGHT_HAND: 300;
export declare const HH_MATCH_PLAYERS: 16;
export declare const HH_MATCH_PACKET_BYTES: 1200;
export declare const HH_MATCH_INPUTS_BYTES: 8192;
export declare const HH_MATCH_NO_SLOT: 4294967295;
export declare const HH_MATCH_PLACES: 64;
export declare const HH_MATCH_REFUSALS: 16;
export declare const HH_OK: 0;
/** a pointer that is needed is null */
export declare const HH_ERROR_NULL: 1;
/** a size of a struct is not of a version that the library knows */
export declare const HH_ERROR_VERSION: 2;
/** an id is null, stale or of another world */
export declare const HH_ERROR_HANDLE: 3;
/** a number is NaN or out of range, or a combination makes no sense */
export declare const HH_ERROR_VALUE: 4;
/** a name is taken, or nothing has it */
export declare const HH_ERROR_NAME: 5;
/** not possible now, for instance a shape in use */
export declare const HH_ERROR_STATE: 6;
/** the buffer is too small; the count says how much is needed */
export declare const HH_ERROR_CAPACITY: 7;
/** bytes that cannot be read: a snapshot, a glTF file, JSON */
export declare const HH_ERROR_DATA: 8;
/** no memory left */
export declare const HH_ERROR_MEMORY: 9;
/** a defect of the library; hh_host_hooks.assert_failed was called */
export declare const HH_ERROR_INTERNAL: 10;
export declare const HH_LEFT: 0;
export declare const HH_RIGHT: 1;
export declare const HH_LOG_NOTE: 0;
export declare const HH_LOG_ERROR: 1;
/** left-handed, +X right, +Y up, +Z ahead, metres */
export declare const HH_ENGINE_UNITY: 0;
/** left-handed, +X ahead, +Y right, +Z up, centimetres */
export declare const HH_ENGINE_UNREAL: 1;
/** as Handhold: right-handed, +X right, +Y up, -Z ahead, metres */
export declare const HH_ENGINE_GODOT: 2;
/** dynamic bodies */
export declare const HH_MOMENTUM_BODIES: 0;
export declare const HH_MOMENTUM_PLAYERS: 1;
/** impulses of hands on bodies that did not push the player back */
export declare const HH_MOMENTUM_DISCARDED: 2;
/** static and kinematic bodies */
export declare const HH_MOMENTUM_STATICS: 3;
export declare const HH_MOMENTUM_RECEIVERS: 4;
/** never moves, except by hh_body_teleport */
export declare const HH_STATIC: 0;
/** moved by hh_body_move_kinematic; pushes others and carries hands */
export declare const HH_KINEMATIC: 1;
/** moved by its velocity, contacts, joints and hands */
export declare const HH_DYNAMIC: 2;
/** points coincide; coordinate: angle between the axes, rad; limits: a cone */
export declare const HH_BALL: 0;
/** turns about the axis; coordinate: angle, rad */
export declare const HH_HINGE: 1;
/** moves along the axis; coordinate: displacement, m */
export declare const HH_SLIDER: 2;
/** no coordinate */
export declare const HH_FIXED: 3;
/** coordinate: distance of two points, m; lower 0: a rope; equal limits: a rod */
export declare const HH_DISTANCE: 4;
export declare const HH_MOTOR_NONE: 0;
/** towards a speed of the coordinate */
export declare const HH_MOTOR_SPEED: 1;
/** towards a coordinate */
export declare const HH_MOTOR_POSITION: 2;
export declare const HH_GRIP_NONE: 0;
/** something static, kinematic or heavy: the player moves */
export declare const HH_GRIP_SURFACE: 1;
/** a dynamic body: it moves with the hand */
export declare const HH_GRIP_HELD: 2;
/** in one of the body's authored grips */
export declare const HH_GRIP_AUTHORED: 3;
/** another player: head, arm, trunk or leg */
export declare const HH_GRIP_PLAYER: 4;
/** The palm of an empty, tracked hand came within 2 cm times the player's scale of a body or of another player's head. */
export declare const HH_EVENT_TOUCHED: 0;
/** a hand grips */
export declare const HH_EVENT_GRABBED: 1;
/** the player opened the hand, or `reason` says who did */
export declare const HH_EVENT_RELEASED: 2;
/** a hand closed and grips nothing: `reason` */
export declare const HH_EVENT_REFUSED: 3;
/** a hand lost its grip: `reason` */
export declare const HH_EVENT_SLIPPED: 4;
/** The player's head, or what a hand holds, hits a body or another player's head. */
export declare const HH_EVENT_CONTACT_BEGAN: 5;
export declare const HH_EVENT_CONTACT_ENDED: 6;
/** of `joint` */
export declare const HH_EVENT_LATCH_CLOSED: 7;
export declare const HH_EVENT_LATCH_OPENED: 8;
/** a joint came to its lower or upper limit */
export declare const HH_EVENT_LIMIT_REACHED: 9;
/** hh_player_pose.origin was changed so that a recentring moves nothing. HH_REASON_BY_HOST: by hh_player_recenter; HH_REASON_NONE: the samples jumped. `position`: the head. */
export declare const HH_EVENT_RECENTRED: 10;
export declare const HH_REASON_NONE: 0;
/** the player opened the hand */
export declare const HH_REASON_OPENED: 1;
/** nothing in reach, or only behind a wall */
export declare const HH_REASON_NO_SURFACE: 2;
/** a grab rule or layers refuse the hand */
export declare const HH_REASON_NOT_ALLOWED: 3;
/** the other hand is not there, or left */
export declare const HH_REASON_NEEDS_TWO_HANDS: 4;
/** farther from its anchor than hand.max_stretch_m */
export declare const HH_REASON_STRETCHED: 5;
/** it opened unseen, or came back too far away */
export declare const HH_REASON_TRACKING_LOST: 6;
/** the body was removed */
export declare const HH_REASON_BODY_GONE: 7;
/** hh_hand_release, hh_hand_grip, hh_hand_hold, hh_body_set_shape or a teleport */
export declare const HH_REASON_BY_HOST: 8;
/** the other of two hands on a body let go */
export declare const HH_REASON_OTHER_HAND: 9;
export declare const HH_SPACE_WORLD: 0;
/** in the parent joint's frame; roots: in the world */
export declare const HH_SPACE_PARENT: 1;
export declare const HH_HAND_PALM: 0;
export declare const HH_HAND_WRIST: 1;
export declare const HH_THUMB_METACARPAL: 2;
export declare const HH_THUMB_PROXIMAL: 3;
export declare const HH_THUMB_DISTAL: 4;
export declare const HH_THUMB_TIP: 5;
export declare const HH_INDEX_METACARPAL: 6;
export declare const HH_INDEX_PROXIMAL: 7;
export declare const HH_INDEX_INTERMEDIATE: 8;
export declare const HH_INDEX_DISTAL: 9;
export declare const HH_INDEX_TIP: 10;
export declare const HH_MIDDLE_METACARPAL: 11;
export declare const HH_MIDDLE_PROXIMAL: 12;
export declare const HH_MIDDLE_INTERMEDIATE: 13;
export declare const HH_MIDDLE_DISTAL: 14;
export declare const HH_MIDDLE_TIP: 15;
export declare const HH_RING_METACARPAL: 16;
export declare const HH_RING_PROXIMAL: 17;
export declare const HH_RING_INTERMEDIATE: 18;
export declare const HH_RING_DISTAL: 19;
export declare const HH_RING_TIP: 20;
export declare const HH_LITTLE_METACARPAL: 21;
export declare const HH_LITTLE_PROXIMAL: 22;
export declare const HH_LITTLE_INTERMEDIATE: 23;
export declare const HH_LITTLE_DISTAL: 24;
export declare const HH_LITTLE_TIP: 25;
export declare const HH_HIPS: 0;
export declare const HH_SPINE: 1;
export declare const HH_CHEST: 2;
export declare const HH_UPPER_CHEST: 3;
export declare const HH_NECK: 4;
export declare const HH_HEAD: 5;
export declare const HH_LEFT_SHOULDER: 6;
export declare const HH_LEFT_UPPER_ARM: 7;
export declare const HH_LEFT_LOWER_ARM: 8;
export declare const HH_LEFT_HAND: 9;
export declare const HH_RIGHT_SHOULDER: 10;
export declare const HH_RIGHT_UPPER_ARM: 11;
export declare const HH_RIGHT_LOWER_ARM: 12;
export declare const HH_RIGHT_HAND: 13;
export declare const HH_LEFT_UPPER_LEG: 14;
export declare const HH_LEFT_LOWER_LEG: 15;
export declare const HH_LEFT_FOOT: 16;
export declare const HH_RIGHT_UPPER_LEG: 17;
export declare const HH_RIGHT_LOWER_LEG: 18;
export declare const HH_RIGHT_FOOT: 19;
export declare const HH_BODY_JOINT_COUNT: 20;
export declare const HH_ROWS_POINT: 0;
export declare const HH_ROWS_WELD: 1;
export declare const HH_ROWS_DIRECTION: 2;
export declare const HH_MATCH_CLIENT: 0;
export declare const HH_MATCH_SERVER: 1;
/** No network: every tick is stepped again from `sync_ticks` before, and must give the same hashes. Finds state that your game forgets to restore. */
export declare const HH_MATCH_SYNC_TEST: 2;
/** Nobody's machine: steps confirmed ticks only, from hh_match_confirmed_inputs. For those who watch, and for recordings of matches. Has no slot and sends no packets. */
export declare const HH_MATCH_SPECTATOR: 3;
/** It happened in a tick that may change. Each such event is confirmed or retracted later. */
export declare const HH_MATCH_PREDICTED: 0;
/** its tick is final. Each event of a confirmed tick comes so once */
export declare const HH_MATCH_CONFIRMED: 1;
/** a predicted event that did not happen */
export declare const HH_MATCH_RETRACTED: 2;
/** shorter than any packet, or longer */
export declare const HH_MATCH_REFUSED_SIZE: 1;
/** damaged */
export declare const HH_MATCH_REFUSED_CHECKSUM: 2;
/** of another version of the format, or another kind */
export declare const HH_MATCH_REFUSED_VERSION: 3;
/** another slot's, or of one that is not connected */
export declare const HH_MATCH_REFUSED_SENDER: 4;
/** fields out of range */
export declare const HH_MATCH_REFUSED_MALFORMED: 5;
/** inputs before it have not arrived. Usual with losses */
export declare const HH_MATCH_REFUSED_GAP: 6;
/** too old or too far ahead. Usual around joins */
export declare const HH_MATCH_REFUSED_WINDOW: 7;
/** a state that hh_match_join could not restore */
export declare const HH_MATCH_REFUSED_STATE: 8;

export interface hh_vec3 {
    x: number;
    y: number;
    z: number;
}

export interface hh_quat {
    x: number;
    y: number;
    z: number;
    w: number;
}

/** A rigid transform: rotates, then translates. Inputs need a unit rotation within 0.001. */
export interface hh_pose {
    /** metres */
    position: hh_vec3;
    rotation: hh_quat;
}

/** How far each finger is bent: thumb, index, middle, ring, little. 0: straight; 1: as in a fist; above 1: as 1; below 0 or NaN: unknown. */
export interface hh_finger_curls {
    fingers: number[];
}

/** Ids: plain values. All zero is null. An id whose object was removed finds nothing, even if its index is used again. Ids of two worlds must not be mixed; that is not always detected. */
export interface hh_shape {
    index: number;
    generation: number;
}

export interface hh_body {
    index: number;
    generation: number;
}

export interface hh_joint {
    index: number;
    generation: number;
}

export interface hh_player {
    index: number;
    generation: number;
}

/** Functions of the host that the library uses. Null functions are not called; without parallel_for the library has its own threads. Memory comes from the global operator new, which a program may replace as usual; the shared library and the standard library inside it then use the replacement too, once per process. Apart from that a world's blocks are taken and given back by the threads that call it, and by those of parallel_for: a replacement with an arena a thread gives each world its own. A host that uses Bullet needs its double-precision build, and sets btAlignedAllocSetCustom before the first world. */
export interface hh_host_hooks {
    /** Called by any thread that calls the library. `message` is one line, valid during the call. */
    log: ((level: number, message: string) => void) | null;
    /** A defect of the library was found; the call then returns HH_ERROR_INTERNAL. */
    assert_failed: ((message: string) => void) | null;
    /** Calls task(task_context, i) once for every i in [0, count), on any threads, and returns when all are done. Indices should start in ascending order. */
    parallel_for: ((count: number, task: (index: number) => void) => void) | null;
    /** Without parallel_for: threads of the library's own pool, the caller's included. [1, 256]; default 1. Results do not depend on it. */
    thread_count: number;
}

export interface hh_world_def {
    /** Fingers and palms close on what they grip. Default true. Without it no shape needs a grip mesh, hands are shown as tracked, and meshes are added faster: for servers. */
    fits_hands: boolean;
    /** HH_EVENT_TOUCHED is reported: one query a step for each empty hand. Default true. */
    reports_touches: boolean;
    /** of dynamic bodies; default 0. Each axis within 1e4 */
    gravity_mps2: hh_vec3;
    /** of the scene: what counts as rest. Each axis within 1e6 */
    reference_velocity_mps: hh_vec3;
}

/** One reading of the headset and both controllers. A pose at exactly (0, 0, 0) counts as not tracked, since runtimes report devices that sleep so. */
export interface hh_tracking_sample {
    /** On the world's clock: hh_world_time plus the step for a sample at the step's end. A sample that is not later than the one before is ignored and counted as sample_out_of_order. More than 0.5 s after the step's end, it is dropped and counted as sample_too_far_ahead, unless hh_player_input.repeats_samples; more than 0.5 s before the step's start, it is counted as sample_too_old. If all samples of a player in a step are so far off, the log is told, once per world, that they are on another clock. hh_world_step_pose_only takes any times. */
    time_s: number;
    /** between the eyes, in play space: the frame that the tracking is given in */
    head: hh_pose;
    /** controllers, by hh_side; see hh_player_set_hand_in_controller */
    hands: hh_pose[];
    /** false: `head` is ignored */
    head_tracked: boolean;
    /** false: the pose is ignored, `grab` counts */
    hand_tracked: boolean[];
    /** a button that closes the hand is down */
    grab: boolean[];
    /** how far it is pressed, [0, 1]: bends fingers until `grab` closes them */
    squeeze: number[];
    /** How far the index finger's trigger is pressed, [0, 1]: bends the index finger of an empty hand, and the fingers of authored grips that follow the trigger. */
    trigger: number[];
    /** True if the runtime only guesses the head's position: OpenXR's POSITION_VALID without POSITION_TRACKED, WebXR's emulatedPosition, a low confidence. Default false; true overrides head_tracked. The head follows the guess, but while a hand grips what the player can pull on, only its rotation does. */
    head_inferred: boolean;
    /** The same for the hands; true overrides hand_tracked. An inferred hand does not begin to grip, and never moves a player who grips: it stays where it was last measured. Opening `grab` lets go, without a throw. The shown empty hand follows the guess. When the hand is measured again, its displacement since does not count as travel. */
    hand_inferred: boolean[];
    /** Bend of the fingers of an empty hand; known curls override squeeze and trigger. Default unknown. Measured by gloves, or made from joints by hh_finger_curls_of. */
    curls: hh_finger_curls[];
}

/** What a player asks for in one step. All zero: nothing. Grows with hh_player_input, of which it is the last field. In the fields of later versions, too, 0 will ask for nothing. */
export interface hh_commands {
    /** [-1, 1], positive turns left */
    smooth_turn: number;
    /** turns to the left begun in this step; negative: to the right */
    snap_turns: number;
    /** [0, 1] */
    brake: number;
    /** play space, each in [-1, 1]; needs locomotion.thruster_mps2 above 0 */
    thrust: hh_vec3;
    /** held while the player holds a T-pose: measures the body */
    calibrate: boolean;
}

/** One player's input of one step. Fill by hh_default_player_input. */
export interface hh_player_input {
    player: hh_player;
    /** The samples since the last step, sorted by time. Give each once. Up to 64 may be later than this step's end, by at most 0.5 s, as predicted poses are: the poses at the end are then interpolated, and each sample is kept for the step of its time, even if that step has no input. A new sample replaces kept samples of the same time or later. None: the devices are silent, except for kept samples. */
    samples: hh_tracking_sample[];
    /** True: the host gives a sample that is later than the step's end again in the next step, so the world keeps none, and sample times are exact. False, the default: up to a microsecond after the step's end counts as the end. For hosts that have the whole stream: recordings, rollback. */
    repeats_samples: boolean;
    commands: hh_commands;
}

/** Sums of all impulses of a step, by hh_momentum_receiver. Each array's sum is 0. */
export interface hh_momentum {
    linear_kgmps: hh_vec3[];
    /** about the world's origin */
    angular_kgm2ps: hh_vec3[];
}

/** Numbers of the last step. */
export interface hh_world_stats {
    bodies: bigint;
    joints: bigint;
    players: bigint;
    /** now */
    shapes: bigint;
    contacts: bigint;
    /** groups of bodies that constraints connect */
    islands: bigint;
    /** of all solves */
    newton_iterations: bigint;
    /** largest distance of a gripping hand from its anchor */
    hand_error_m: number;
    /** worst contact overlap at the end */
    overlap_m: number;
    /** largest position error of a joint */
    joint_error_m: number;
    /** sum of all stages */
    step_us: number;
    /** largest error of a joint's direction, or angle beyond a limit */
    joint_error_rad: number;
    /** islands in which something pushed a player back */
    islands_pushed: bigint;
    /** searches for contacts inside the solve */
    contact_rounds: bigint;
    /** hands that closed */
    hands_closed: bigint;
    /** grips that began */
    hands_gripped: bigint;
    momentum: hh_momentum;
    /** The two of `overlap_m`; null: a player's head, or no overlap. */
    deepest_a: hh_body;
    /** The two of `overlap_m`; null: a player's head, or no overlap. */
    deepest_b: hh_body;
}

/** A tunable number, or a vector of three. Texts live as long as the process. */
export interface hh_tuning_info {
    /** "hand.reach_m" */
    name: string | null;
    /** "m", "" */
    unit: string | null;
    what: string | null;
    low: number;
    /** of each component */
    high: number;
    /** 1 or 3 */
    count: number;
    /** true: each player has the number times hh_player_def.scale */
    scales: boolean;
}

/** A part of a compound: any shape but a mesh or a compound. */
export interface hh_compound_part {
    shape: hh_shape;
    /** in the compound's frame */
    pose: hh_pose;
    /** give it for all parts, or 0 for all: the mass is then spread by volume */
    mass_kg: number;
}

export interface hh_mesh_def {
    /** x, y, z of each vertex, metres */
    positions: ArrayLike<number>;
    /** bytes from one vertex to the next; 0: 12 */
    vertex_stride: number;
    indices: ArrayLike<number>;
    /** default true; false: hands on it are shown as tracked */
    fits_hands: boolean;
}

/** A body's pose is that of its shape's own frame, as the host made it: the library finds centre of mass and principal axes by itself. Velocities are those of the centre of mass, in the world. */
export interface hh_body_def {
    /** unique in the world, identifies the body in hashes; null: by its id */
    name: string | null;
    kind: number;
    /** null: touches nothing */
    shape: hh_shape;
    pose: hh_pose;
    /** each within 1e6 */
    velocity_mps: hh_vec3;
    /** each within 1e4 */
    angular_velocity_radps: hh_vec3;
    /** dynamic: [1e-12, 1e15], default 1 */
    mass_kg: number;
    /** About the principal axes; 0: computed from the shape. A dynamic body without a shape needs one: HH_ERROR_VALUE. */
    inertia_kgm2: hh_vec3;
    /** [0, 1] */
    restitution: number;
    /** [0, 1e6], default 0.4 */
    friction: number;
    /** default 1; within 1000 */
    gravity_scale: number;
    layers: number;
    /** two bodies touch if each one's layers meet the other's mask */
    mask: number;
    grab_left: boolean;
    /** which hands may grip it; default both */
    grab_right: boolean;
    /** only both hands of one player at once */
    grab_two_hands: boolean;
    /** of bodies in reach, hands take one of highest priority; default 0 */
    grab_priority: number;
    /** the host's; not part of the state */
    user_data: bigint;
}

export interface hh_joint_def {
    /** unique in the world; null: by its id */
    name: string | null;
    kind: number;
    /** null: the world */
    body_a: hh_body;
    body_b: hh_body;
    /** in the world, with the bodies where they are now: x is the joint's axis */
    frame: hh_pose;
    /** HH_DISTANCE: the point on body_b, in the world; the point on body_a is frame's. */
    point_b: hh_vec3;
    /** the two bodies touch each other; default false */
    collides: boolean;
    /** lower and upper apply; distance joints are always limited */
    limited: boolean;
    lower: number;
    upper: number;
    /** N, or N m about a hinge or any axis of a ball; >= 0 */
    friction: number;
    /** a rest position at each multiple; 0: none */
    detent_spacing: number;
    /** force towards the nearest rest position, N or N m */
    detent_strength: number;
    /** the latch locks the coordinate at this */
    latch_at: number;
    /** the latch closes within this distance; 0: no latch */
    latch_range: number;
    /** the latch opens above this force, N or N m; 0: never by force */
    latch_strength: number;
    /** a joint that opens it; null: none */
    latch_handle: hh_joint;
    /** open while |handle's coordinate| is at least this */
    latch_handle_at: number;
}

export interface hh_motor_def {
    /** default HH_MOTOR_NONE */
    kind: number;
    /** HH_MOTOR_SPEED: rad/s or m/s, within 1e9 */
    speed: number;
    /** HH_MOTOR_POSITION: rad or m, within 1e9; a hinge counts full turns */
    position: number;
    /** HH_MOTOR_POSITION: the joint moves so fast that it would be there after this; a step at least, 1e9 at most, s; default 0.1 */
    time_s: number;
    /** largest force, N or N m, [0, 1e15]; default 0 */
    strength: number;
}

/** Two surfaces that touched in the last step. Whichever of body and player is not null it is: a player's head, or a body. */
export interface hh_contact {
    body_a: hh_body;
    body_b: hh_body;
    player_a: hh_player;
    player_b: hh_player;
    /** on the surface of a, in the world */
    point: hh_vec3;
    /** unit, from b to a */
    normal: hh_vec3;
    /** how deep they overlap; negative: apart */
    depth_m: number;
    /** that the step applied, >= 0 */
    impulse_ns: number;
}

/** Queries test the shapes of all bodies, whatever their layers, and the tracked heads of players, at their present poses. Bodies without a shape, and surfaces of hh_world_set_surface_query, are not found. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; the first query after a change of the world also compares every body with its place before. */
export interface hh_hit {
    /** null: a player's head, or nothing was found */
    body: hh_body;
    /** whose head; null: a body, or nothing was found */
    player: hh_player;
    /** on the surface, in the world */
    point: hh_vec3;
    /** unit, to the side that the query came from */
    normal: hh_vec3;
    /** see each query */
    distance_m: number;
}

/** Sizes of a player's body, each in [0.05, 5] m times hh_player_def.scale. */
export interface hh_measures {
    /** standing */
    eye_height_m: number;
    /** between the shoulder joints */
    shoulder_width_m: number;
    upper_arm_m: number;
    /** to the wrist */
    forearm_m: number;
}

export interface hh_player_def {
    /** unique in the world; null: by its id */
    name: string | null;
    /** the space of the samples in the world */
    origin: hh_pose;
    velocity_mps: hh_vec3;
    /** default 80 */
    mass_kg: number;
    /** Before scale: each in [0.05, 5] m. Default: unknown, the size is estimated from head and hands while the player plays, within 20 s and by less than 1 mm a step. Other measures stay. */
    measures: hh_measures;
    /** Size of the player, [0.01, 100], default 1; else HH_ERROR_VALUE. Body, head, hands, reach and every number with hh_tuning_info.scales are times this. Samples and all results stay in the world's metres: a host gives the tracked poses times the scale. Tested from 0.1 to 20. The first hand of another scale than 1 that grips a shape copies its surface, at about 0.2 microseconds a triangle. */
    scale: number;
    /** the head is a sphere of head.radius_m times scale; default true */
    head_collides: boolean;
    /** Layers of the head; it touches a body if each one's layers meet the other's mask. */
    layers: number;
    /** Layers of the head; it touches a body if each one's layers meet the other's mask. */
    mask: number;
    /** the hands grip bodies with one of these layers; default all */
    grab_layers: number;
    user_data: bigint;
}

/** Grows: see base.h. */
export interface hh_hand_state {
    grip: number;
    /** gripped; null: none */
    body: hh_body;
    /** gripped player; null: none */
    other: hh_player;
    /** the wrist in the world, as the devices say */
    tracked: hh_pose;
    /** The wrist to draw. While it grips it is fitted to the surface near the anchor: centimetres from it, so that palm and fingers touch. A lost or never tracked hand that grips nothing hangs beside the trunk; it goes there and comes back at a bounded speed. */
    shown: hh_pose;
    /** The wrist in the frame of what it grips (a body, or a part of a player), from when the hand closed. The hand takes a new anchor after tracking errors, when the other hand of a shared grip lets go, and when the body's kind or mass changes. */
    anchor: hh_pose;
    /** Distance of the tracked wrist from the anchor: 0 unless something blocks it. */
    error_m: number;
    /** Impulse of the hand on what it grips in the last step, for haptics. 0 if the host's solver moved the player (hh_world_end_step): read it there. While hands move only light bodies, the reported impulses of hands and contacts are limited to the momentum that the players and bodies involved have at their speeds plus the hands' speed. */
    force_impulse_ns: hh_vec3;
    /** false while the hand is lost or inferred */
    is_tracked: boolean;
    /** the button is down */
    is_closed: boolean;
    /** The runtime guesses where the hand is (hh_tracking_sample.hand_inferred). `tracked` is the guess for an empty hand, and for a body in it while no hand of the player moves the player; else the last pose that was measured. */
    is_inferred: boolean;
}

/** Grows: see base.h. Later fields come behind `hands`. */
export interface hh_player_pose {
    /** The space of the samples in the world: put the camera rig here. Controllers at origin * sample are where the hands are, also after a recentring, which changes it so that nothing in the world moves. */
    origin: hh_pose;
    /** between the eyes, in the world */
    head: hh_pose;
    /** of the play space */
    velocity_mps: hh_vec3;
    /** by hh_side */
    hands: hh_hand_state[];
}

/** Grows: see base.h. Later versions also have more kinds and reasons: ignore those you do not know. */
export interface hh_event {
    kind: number;
    reason: number;
    /** null: a joint's event that concerns no hand */
    player: hh_player;
    /** hh_side; -1: no hand: the head or a joint alone */
    side: number;
    /** touched, gripped, held or hit; null: a player, or nothing */
    body: hh_body;
    /** gripped or hit player; null: none */
    other: hh_player;
    /** contacts: what the hand holds; null: the head */
    held: hh_body;
    /** whose latch or limit it is; null: none */
    joint: hh_joint;
    /** in the world: of the wrist, the contact, the joint or the head */
    position: hh_vec3;
    /** of a contact that began: >= 0, for haptics and sound */
    impulse_ns: number;
}

export interface hh_hand_joint {
    pose: hh_pose;
    radius_m: number;
    /** false: the hand's rig has no such joint */
    is_valid: boolean;
}

export interface hh_skeleton_joint {
    /** as in the engine's file; null: none */
    name: string | null;
    /** index; -1: a root */
    parent: number;
    /** HH_IS_..., for names that nobody can guess. Spine and palms need none: joints of the trunk follow by their height, joints of the palm follow the hand. */
    is: number;
    /** In the space given, without scale: T-pose or A-pose, +Y up, of any size and heading. */
    bind: hh_pose;
}

export interface hh_finger {
    /** false: the finger closes on the surface as usual */
    is_posed: boolean;
    /** of its hinges, from the knuckle; each within pi */
    curl_rad: number[];
    /** thumb; of a finger: spread towards the thumb, clamped to 0.17 */
    opposition_rad: number;
    /** The finger moves from these angles to the pressed ones as far as the sample's `trigger` is pressed. The pressed angles may reach into the body: a trigger gives way. */
    follows_trigger: boolean;
    pressed_curl_rad: number[];
    pressed_opposition_rad: number;
}

export interface hh_grip_hand {
    /** false: this hand cannot take the grip */
    is_used: boolean;
    /** in the body's frame */
    wrist: hh_pose;
    /** thumb, index, middle, ring, little */
    fingers: hh_finger[];
}

export interface hh_grip_def {
    /** by hh_side */
    hands: hh_grip_hand[];
    /** of several in reach, the highest is taken */
    priority: number;
    /** of the palm, [0, 10]; default 0.08 */
    snap_radius_m: number;
    /** [0, pi]; default pi / 3 */
    snap_angle_rad: number;
}

/** What a query found. Ignored, and counted as surface_answer_invalid: a body that is not in the world, numbers that are not finite, a point beyond 1e9 m, a normal of length zero. */
export interface hh_surface_hit {
    body: hh_body;
    /** on the surface, in the world */
    point: hh_vec3;
    /** out of the solid or towards the query; need not have length 1 */
    normal: hh_vec3;
    /** see each query */
    distance_m: number;
}

/** Queries against the host's surfaces. Each returns true if it found something, and then fills `hit`. `skip`: bodies that count as not there. Called only inside hh_world_step, _step_hands, _begin_step, _end_step, _step_pose_only and hh_hand_find_grip of this world, by the thread that made that call. A query may read the world; calls that change it return HH_ERROR_STATE. Per player and frame: about 3 queries, up to 50 when a hand closes behind walls or among bodies. */
export interface hh_surface_query {
    /** First surface that the segment hits, from outside or inside. distance_m is not read. */
    cast_ray: ((from: hh_vec3, to: hh_vec3, skip: hh_body[]) => Given<hh_surface_hit> | null) | null;
    /** First impact of a sphere moving along a segment; distance_m: how far its centre has moved. For the distance grab (pull.reach_m above 0), and to keep trunk and legs out of surfaces: about one query per player and frame. Null: neither. */
    cast_sphere: ((radius_m: number, from: hh_vec3, to: hh_vec3, skip: hh_body[]) => Given<hh_surface_hit> | null) | null;
    /** Nearest surface point within max_distance_m; distance_m: 0 inside a solid. */
    closest_point: ((point: hh_vec3, max_distance_m: number, skip: hh_body[]) => Given<hh_surface_hit> | null) | null;
    /** Nearest surface point of one body, at any distance; distance_m: 0 inside a solid. */
    closest_point_on: ((body: hh_body, point: hh_vec3) => Given<hh_surface_hit> | null) | null;
}

export interface hh_body_motion {
    body: hh_body;
    /** of the shape's own frame; without a shape: centre of mass and principal axes */
    pose: hh_pose;
    velocity_mps: hh_vec3;
    angular_velocity_radps: hh_vec3;
}

export interface hh_hand_constraint {
    player: hh_player;
    side: number;
    body: hh_body;
    rows: number;
    /** the wrist in the body's frame */
    anchor: hh_pose;
    /** the wrist at the end of the step: from the origin, with the world's axes */
    target: hh_pose;
    /** The target's velocity relative to the origin: the throwing velocity while a hand lets go, else the mean over the step. */
    velocity_mps: hh_vec3;
    angular_velocity_radps: hh_vec3;
    /** in the world, at the end of the step; not for POINT */
    body_rotation: hh_quat;
    /** reaches body_rotation; not for POINT */
    body_angular_velocity_radps: hh_vec3;
    /** The anchor in the world at the end of the step, if the body keeps its velocity. Exact for static and kinematic bodies: a joint may attach the player to this point of the world. */
    anchor_end: hh_pose;
    /** of the rows; 0: rigid, as in the runtime's own solver */
    compliance_m_per_n: number;
    /** enough to stop what the hand drives from its highest speed in one step */
    max_force_n: number;
    /** the hand lets go in this step */
    is_releasing: boolean;
}

/** A player's body in the host's solver. */
export interface hh_player_motion {
    player: hh_player;
    /** at the start of the step */
    origin: hh_vec3;
    /** at the start of the step, with thrusters and drag applied */
    velocity_mps: hh_vec3;
    /** For this step. The player's own while a hand grips something static, kinematic or at least phases.heavy_body_kg. Else 1000 times the heaviest held body, so that light bodies do not shake the player; for bodies from phases.kappa_light_kg to phases.kappa_heavy_kg it falls to the player's own. If a held body meets something that does not give way, such as a crate at a wall, solve the step again with hh_player_def.mass_kg: the player then moves back by what the body could not move. Without that, hand and wall press against each other without a bound. */
    mass_kg: number;
    /** of the head's centre: from the origin, with the world's axes */
    head: hh_pose;
    /** the host may let this sphere collide, on the player's body */
    head_radius_m: number;
}

export interface hh_solved_player {
    player: hh_player;
    /** at the end of the step */
    origin: hh_vec3;
    /** at the end of the step */
    velocity_mps: hh_vec3;
}

/** A velocity that the host gives its body. */
export interface hh_velocity_change {
    body: hh_body;
    velocity_mps: hh_vec3;
    angular_velocity_radps: hh_vec3;
}

export interface hh_match_def {
    /** default HH_MATCH_CLIENT */
    role: number;
    /** by slot, the same on every machine; copied. All are in the world, also while nobody plays them */
    players: hh_player[];
    /** length of a tick, [1e-3, 0.1]; default 1/90 */
    tick_s: number;
    /** client: this machine's player; default 0 */
    slot: number;
    /** sync test: ticks stepped again each time, [1, 62]; default 8 */
    sync_ticks: number;
    /** server: time on its clock at the world's present tick; default 0 */
    start_s: number;
}

/** Your own state of the match, such as scores and doors' codes, which goes back and forth with the world's. Null functions are not called; `save` and `restore` come together. Inside of them no function of the match may be called, and none that steps, restores or destroys the world. */
export interface hh_match_game {
    /** Called after each step of the world to `tick`, also when it is stepped again. May read the world and its events, and may change its bodies, joints, grips and players; it must not add or remove any. What it does may depend on the world, your state, `tick` and `buttons` only: hh_match_input.buttons of each slot, of which there are `button_count`. What hosts draw, such as hh_player_pose, differs between machines. */
    step: ((tick: bigint, buttons: number[]) => void) | null;
    /** Keeps a copy of your state in a place of yours, [0, HH_MATCH_PLACES), over the one before. A server saves nothing. */
    save: ((place: number) => void) | null;
    /** Sets your state to the copy in that place. */
    restore: ((place: number) => void) | null;
    /** Hash of your state: machines compare it together with the world's. */
    hash: (() => bigint | number) | null;
}

/** A player's input for one tick. Fill by hh_default_match_input. */
export interface hh_match_input {
    /** your bits, for hh_match_game.step */
    buttons: number;
    /** As in hh_player_input, on the world's clock: a sample at the tick's end has hh_world_time plus tick_s. Later ones are kept for later ticks, at most 64. Poses become integers of 0.1 mm and 1 mrad, the same on every machine. Without a sample for 0.1 s devices count as not tracked. */
    samples: hh_tracking_sample[];
    /** True: the tick is not shown, as by hh_world_step_simulated. For all but the last of several ticks in one frame. Default false. */
    is_hidden: boolean;
    commands: hh_commands;
}

/** The first tick whose hash changed when it was stepped again. */
export interface hh_match_difference {
    /** 0: none */
    tick: bigint;
    /** hh_world_simulated_hash differs */
    in_world: boolean;
    /** hh_match_game.hash differs */
    in_game: boolean;
}

/** Grows with hh_event, its last field. */
export interface hh_match_event {
    tick: bigint;
    state: number;
    /** `position` is that of the tracked hand, not of the shown one */
    event: hh_event;
}

/** Counts since the match began, where nothing else is said. */
export interface hh_match_stats {
    /** the world's present tick */
    tick: bigint;
    /** the last tick whose state is final here */
    confirmed: bigint;
    /** ticks that the world advanced */
    ticks: bigint;
    /** clients, sync tests: times that the world went back */
    rollbacks: bigint;
    /** ticks stepped again by them */
    steps_again: bigint;
    /** most ticks that one of them stepped again */
    deepest: bigint;
    /** clients: hh_match_advance that were too far ahead */
    waits: bigint;
    /** inputs that came too late: own ones, or on a server those of all */
    filled: bigint;
    /** servers, spectators: compared hashes */
    hashes: bigint;
    /** servers, spectators: those that differed */
    out_of_sync: bigint;
    /** packets, by hh_match_refusal; on clients, GAP counts their parts */
    refused: bigint[];
}

/** Every function of the library, as a method. They throw a HandholdError if the library refuses the call. */
export declare class LibraryCalls {
    /** The result's name, "HH_ERROR_HANDLE". Never null. Any thread. */
    resultText(result: number): string | null;
    /** The version of the library that is running: compare with HANDHOLD_VERSION_MAJOR and so on. Null pointers are skipped. Any thread. */
    version(): { major: number; minor: number; patch: number };
    /** The pose at the origin, not rotated. Any thread. */
    identityPose(): hh_pose;
    /** Equal on every machine and compiler, unlike sin, cos and atan2 of C: for inputs that must replay bit for bit. Errors are below 1e-14 up to 1e6 rad; beyond that, and for NaN, sine is 0 and cosine 1. Null outputs are skipped. hh_atan2 gives 0 for (0, 0) and NaN. Any thread. */
    sinCos(angle_rad: number): { sine: number; cosine: number };
    atan2(y: number, x: number): number;
    /** Sets the hooks of the process; null: back to the defaults. HH_ERROR_STATE while a world exists. Not beside any other call of the library. */
    setHostHooks(hooks: Given<hh_host_hooks> | null): void;
    /** Sets the number of threads of the library's own pool, [1, 256]. Allowed while worlds exist, for instance to use all cores while a level loads. HH_ERROR_STATE if the host lends parallel_for. Not beside any other call of the library. */
    setThreadCount(count: number): void;
    /** Number of threads of the library's own pool, the caller's included. Any thread. */
    threadCount(): number;
    /** Metres in one of the engine's units of length: 0.01 for Unreal, else 1. For radii and distances. */
    convertMetresPerUnit(engine: number): number;
    /** Whatever scales with length: positions, velocities, accelerations, impulses, forces. */
    convertVectorFrom(engine: number, vector: Given<hh_vec3>): hh_vec3;
    convertVectorTo(engine: number, vector: Given<hh_vec3>): hh_vec3;
    /** Directions without a length: normals, axes. */
    convertDirectionFrom(engine: number, direction: Given<hh_vec3>): hh_vec3;
    convertDirectionTo(engine: number, direction: Given<hh_vec3>): hh_vec3;
    /** Angular velocities in rad/s, and other vectors along an axis of rotation. Left-handed engines count angles the other way, so the sign changes too. */
    convertAngularFrom(engine: number, angular_radps: Given<hh_vec3>): hh_vec3;
    convertAngularTo(engine: number, angular_radps: Given<hh_vec3>): hh_vec3;
    convertRotationFrom(engine: number, rotation: Given<hh_quat>): hh_quat;
    convertRotationTo(engine: number, rotation: Given<hh_quat>): hh_quat;
    convertPoseFrom(engine: number, pose: Given<hh_pose>): hh_pose;
    convertPoseTo(engine: number, pose: Given<hh_pose>): hh_pose;
    /** Scale factors of an object along its own axes, and half extents in metres: axes change places, signs do not. */
    convertScaleFrom(engine: number, scale: Given<hh_vec3>): hh_vec3;
    convertScaleTo(engine: number, scale: Given<hh_vec3>): hh_vec3;
    /** Converts a mesh in place: x, y, z of its vertices. Reverses its triangles if the engine's front faces are clockwise (Unity, Godot), so that they are counter-clockwise from outside. A mirrored object, of which the product of the scales is negative, needs nothing else: give its scale, from hh_convert_scale_from, to hh_shape_add_mesh, which takes negative factors. HH_ERROR_VALUE, and no change, for counts that are no multiples of 3. */
    convertMeshFrom(engine: number, coordinates: ArrayLike<number>, indices: ArrayLike<number>): { coordinates: number[]; indices: number[] };
    /** Stages and fallbacks by index; null beyond the last. A fallback is counted whenever the runtime does the next best instead of what was asked. Any thread. */
    stageName(stage: number): string | null;
    fallbackName(fallback: number): string | null;
    /** The number with this index; HH_ERROR_VALUE beyond the last. Any thread. */
    tuningDescribe(index: number): hh_tuning_info;
    /** "grabbed", "no_surface"; null for numbers that this version does not know. Any thread. */
    eventKindName(kind: number): string | null;
    reasonName(reason: number): string | null;
    /** How far the fingers of a tracked hand are bent, for hh_tracking_sample.curls. `joints`: HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name, in any one space; only positions are read. Curl is the sum of a finger's bends over that of a fist; -1 if a joint of the finger is not valid. Any thread. */
    fingerCurlsOf(joints: Given<hh_hand_joint>[]): hh_finger_curls;
    /** "leftUpperArm"; null beyond the last. Any thread. */
    bodyJointName(joint: number): string | null;
    /** The parent's index; -1 for the hips and beyond the last. */
    bodyJointParent(joint: number): number;
}

/** Every function of a world, as a method. They throw a HandholdError if the library refuses the call. */
export declare class WorldCalls {
    /** Steps the world by dt_s, in [1e-6, 10]; 1/90 is usual. `inputs`: at most one a player, else HH_ERROR_VALUE; players without one are silent. Bad samples are ignored and counted; numbers in commands that are out of range are clamped. Cost: about 0.03 ms for a player who crawls, 0.05 ms for one who grips and lets go all the time, and up to 4 ms in the frame in which a hand closes: docs/guide/cost.md. */
    step(dt_s: number, inputs: Given<hh_player_input>[]): void;
    /** hh_world_step without fitted hands, arms, spine and legs: about a quarter of its cost. What hosts draw stays as the last other step left it: hh_player_pose with its hands, joints of hands and bodies, hh_player_push_back. Everything else changes exactly as in hh_world_step, bit for bit: hh_world_simulated_hash is equal whichever steps were shown. For rollback: step again to the present with this, and the last time with hh_world_step. Events carry the tracked hand's position. */
    stepSimulated(dt_s: number, inputs: Given<hh_player_input>[]): void;
    /** While the game is paused: heads, hands and bodies of players follow their last sample, whatever its time. The clock, bodies, joints, grips and play spaces stand still. Samples that were waiting for their step are dropped. The next hh_world_step goes on: hands that are still closed grip where they are at that time. */
    stepPoseOnly(dt_s: number, inputs: Given<hh_player_input>[]): void;
    /** The world's clock, seconds, and the number of steps. Null outputs are skipped. */
    time(): { time_s: number; frame: bigint };
    /** Acceleration of dynamic bodies; players float. Each axis within 1e4 m/s^2. */
    setGravity(gravity_mps2: Given<hh_vec3>): void;
    /** Velocity of the scene: drifting players come to rest against it. Each axis within 1e6 m/s. */
    setReferenceVelocity(velocity_mps: Given<hh_vec3>): void;
    gravity(): hh_vec3;
    referenceVelocity(): hh_vec3;
    /** Hash of the whole state. Equal on every machine, compiler and number of threads after equal calls with equal names. Not in it: which shape a body has, because ids depend on the order of loading. Cost: linear in the state, about 0.1 ms for a scene of 100 bodies. */
    hash(): bigint;
    /** The same of the simulated state alone, without what hosts draw. Machines that show different frames, or none, compare this. */
    simulatedHash(): bigint;
    /** Saves every bit of the state. Writes the number of bytes to `size`. A null `buffer` only asks for it. HH_ERROR_CAPACITY if it is more than `capacity`. Rigs, tuning and user data are not in a snapshot. Shapes are named by their content: a world that restores it needs equal ones, whatever their ids. */
    save(): Uint8Array;
    /** Back to a saved state, which then goes on bit for bit. Ids taken before the save are valid again. HH_ERROR_DATA, and no change, for bytes that are damaged or name a shape that this world has not. Tolerates any bytes. */
    restore(bytes: Uint8Array | string | null): void;
    getStats(): hh_world_stats;
    /** Time of each stage, microseconds, and how often each fallback occurred, in the last step. `count` gets the number of entries; HH_ERROR_CAPACITY if it is more than `capacity`. */
    stageTimes(): number[];
    fallbacks(): bigint[];
    /** Reads and changes one number by name, between steps. `count` must be the number's. HH_ERROR_NAME for an unknown name, HH_ERROR_VALUE out of range. */
    getTuning(name: string | null, count: number): number[];
    setTuning(name: string | null, values: ArrayLike<number>): void;
    /** All numbers of the tuning, to compare, keep and restore: in the order of hh_tuning_describe, a vector as three. `count` as for hh_world_fallbacks. Set takes exactly all of them; on an error none changes. */
    tuningNumbers(): number[];
    setTuningNumbers(values: ArrayLike<number>): void;
    /** All numbers from JSON, {"hand": {"reach_m": 0.12}}; those that it lacks get their defaults. HH_ERROR_DATA, with the place, for unknown names and wrong numbers. */
    loadTuning(json: Uint8Array | string | null): void;
    /** The additive body clips of all players, from JSON in the format of docs/reference/body_clips.md: idling, pushing off, looking round, raising the arms. They rotate spine, legs and clavicles, never hands. They replace the clips before. Null: none, which is the default. HH_ERROR_DATA, with the place and no change, for anything else. Clips are not in a snapshot: load the same ones before you restore. */
    loadBodyClips(json: Uint8Array | string | null): void;
    /** In a world with fits_hands, a new shape gets a surface for hands on the calling thread; a shape equal to one that is there costs microseconds. Costs are of one core at 2.1 GHz. Large round shapes cost more than a frame: add them while loading. Box: 0.02 ms. */
    shapeAddBox(half_extents_m: Given<hh_vec3>): hh_shape;
    /** Cost with fits_hands: 2 ms at 0.1 m, growing with the radius to 18 ms at 1 m; none above 64 m. */
    shapeAddSphere(radius_m: number): hh_shape;
    /** Along Y; half_height_m without the caps. Cost: as a sphere. */
    shapeAddCapsule(radius_m: number, half_height_m: number): hh_shape;
    /** Along Y. Cost with fits_hands: 0.4 ms at 0.1 m. */
    shapeAddCylinder(radius_m: number, half_height_m: number): hh_shape;
    /** Convex hull of points that are not coplanar. Cost with fits_hands: 1.6 ms for 64 points. */
    shapeAddHull(points: Given<hh_vec3>[]): hh_shape;
    /** 1 to 64 parts that move as one. It keeps copies: the parts may be removed. Cost with fits_hands: as if all its parts were new shapes. */
    shapeAddCompound(parts: Given<hh_compound_part>[]): hh_shape;
    /** A shape of a prepared mesh, for static and kinematic bodies. The size of each factor is in [1e-3, 1e3], others get HH_ERROR_VALUE; negative ones mirror the mesh, whose triangles keep their outer side. Cost: microseconds for scale 1; another scale prepares the hands' surface again, about 40 microseconds a triangle with fits_hands. */
    shapeAddMesh(mesh: Mesh | null, scale: Given<hh_vec3>): hh_shape;
    /** HH_ERROR_STATE while a body or a player has the shape. */
    shapeRemove(shape: Given<hh_shape>): void;
    shapeIsValid(shape: Given<hh_shape>): boolean;
    /** Number of shapes. */
    shapeCount(): number;
    /** Adds a body. Cost: constant, whatever else is in the world. */
    bodyAdd(def: Given<hh_body_def> | null): hh_body;
    /** Removes a body with its joints. Hands that grip it are empty at once; the event follows in the next step. */
    bodyRemove(body: Given<hh_body>): void;
    bodyIsValid(body: Given<hh_body>): boolean;
    bodyFind(name: string | null): hh_body;
    /** Valid until a body is added or removed. Empty if the name came only with a snapshot. */
    bodyName(body: Given<hh_body>): string;
    /** Ids of all bodies; `count` gets their number. HH_ERROR_CAPACITY if it is more than `capacity`. A null buffer of capacity 0: the number only. */
    bodies(): hh_body[];
    bodyPose(body: Given<hh_body>): hh_pose;
    /** Poses of many bodies in one call; HH_ERROR_HANDLE, and nothing written, if one is stale. */
    bodyPoses(bodies: Given<hh_body>[]): hh_pose[];
    /** Null outputs are skipped. */
    bodyVelocity(body: Given<hh_body>): { velocity_mps: hh_vec3; angular_velocity_radps: hh_vec3 };
    /** Within 1e6 m/s and 1e4 rad/s. HH_ERROR_STATE for a body that is not dynamic. */
    bodySetVelocity(body: Given<hh_body>, velocity_mps: Given<hh_vec3>, angular_velocity_radps: Given<hh_vec3>): void;
    /** Changes the velocity by an impulse in N s at a point in the world. HH_ERROR_STATE for a body that is not dynamic, HH_ERROR_VALUE if the velocity would leave the limits of hh_body_set_velocity. */
    bodyApplyImpulse(body: Given<hh_body>, impulse_ns: Given<hh_vec3>, point: Given<hh_vec3>): void;
    /** Moves a body at once, without collisions on the path. It keeps its velocity; hands that grip it let go. */
    bodyTeleport(body: Given<hh_body>, pose: Given<hh_pose>): void;
    /** A kinematic body reaches the pose at the end of the next step and then rests. Call it before every step in which it moves, or less often: a host that ticks slower than it draws may tell each tick's pose once. The body's velocity, with which hands leave it and bodies are thrown, is the displacement since the pose before over the time since then; over tracking.release_window_s if the poses come at varying times. It is 0 once a pose is due that does not come or is the same. The first pose after a rest counts as half a second's motion, since nothing says when it began. */
    bodyMoveKinematic(body: Given<hh_body>, pose: Given<hh_pose>): void;
    bodySetGravityScale(body: Given<hh_body>, scale: number): void;
    bodySetLayers(body: Given<hh_body>, layers: number, mask: number): void;
    bodySetGrabRule(body: Given<hh_body>, left: boolean, right: boolean, two_hands: boolean, priority: number): void;
    bodyGetKind(body: Given<hh_body>): number;
    /** 0 for a body that is not dynamic: nothing that acts on it moves it. */
    bodyMass(body: Given<hh_body>): number;
    /** Mass in [1e-12, 1e15] kg and inertia as hh_body_def's, else HH_ERROR_VALUE; 0 inertia: of the solid shape. Dynamic bodies only: HH_ERROR_STATE. Hands keep their grips: beyond phases.heavy_body_kg the body moves its player from the next step on, below it comes along. */
    bodySetMass(body: Given<hh_body>, mass_kg: number, inertia_kgm2: Given<hh_vec3>): void;
    /** Friction in [0, 1e6], restitution in [0, 1]. Null outputs are skipped. */
    bodyMaterial(body: Given<hh_body>): { friction: number; restitution: number };
    bodySetMaterial(body: Given<hh_body>, friction: number, restitution: number): void;
    /** A body becomes static, kinematic or dynamic where it is. Hands keep their grips without a jump: a body that becomes dynamic comes along, others move the player. A body that becomes static or kinematic stops; one that becomes dynamic keeps its velocity. Joints stay. Mass and inertia: of a body that becomes dynamic, as hh_body_set_mass; of others ignored. A mesh cannot become dynamic: HH_ERROR_VALUE. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. */
    bodySetKind(body: Given<hh_body>, kind: number, mass_kg: number, inertia_kgm2: Given<hh_vec3>): void;
    /** Null for a body without a shape. */
    bodyShape(body: Given<hh_body>): hh_shape;
    /** The body touches with another shape from now on, or with none (null id). A dynamic body needs a solid shape: HH_ERROR_VALUE for none or a mesh. The body's pose, joints and grips stay as they are in the frame in which the host made the shapes, whatever their centres of mass; a dynamic body's inertia becomes that of the solid shape with the same mass. Hands let go in the next step (HH_EVENT_RELEASED, HH_REASON_BY_HOST) if the body has no shape any more, or if their palm is farther from the new surface than a closing hand reaches: hand.ray_length_m minus hand.ray_back_m, or hand.reach_m if that is larger. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; with a mesh that a hand grips, linear in its triangles, 0.1 ms for 5,000. */
    bodySetShape(body: Given<hh_body>, shape: Given<hh_shape>): void;
    bodySetUserData(body: Given<hh_body>, user_data: bigint): void;
    bodyUserData(body: Given<hh_body>): bigint;
    /** Adds a level from the bytes of a glTF file (.glb, or .gltf with its data inside): a static body with a mesh for each node that has triangles, where the file has them, moved by `pose`. Its name is the node's, with a number if the world has that name. `bodies` may be null; `count` gets their number. HH_ERROR_CAPACITY and HH_ERROR_DATA, which says what the file lacks: nothing is added. Cost: that of hh_mesh_create for every triangle. */
    addGltfLevel(gltf: Uint8Array | string | null, pose: Given<hh_pose>): hh_body[];
    jointAdd(def: Given<hh_joint_def> | null): hh_joint;
    jointRemove(joint: Given<hh_joint>): void;
    jointIsValid(joint: Given<hh_joint>): boolean;
    /** Ids of the joints of a body; `count` gets their number. HH_ERROR_CAPACITY if it is more than `capacity`. A null buffer of capacity 0: the number only. */
    bodyJoints(body: Given<hh_body>): hh_joint[];
    /** Drives a hinge or slider from the next step on, with a limited force, as friction acts; replaces its detents. A position's target moves a stiff drive: a load below the strength does not deflect it. Part of the state. HH_ERROR_VALUE for other kinds of joints. Cost: that of a joint with friction. */
    jointSetMotor(joint: Given<hh_joint>, def: Given<hh_motor_def> | null): void;
    /** New limits of the coordinate, as in hh_joint_def; equal ones lock the joint there. A joint beyond them is moved within. Bodies move at once: hands that held on may slip. */
    jointSetLimits(joint: Given<hh_joint>, limited: boolean, lower: number, upper: number): void;
    /** A new latch, as in hh_joint_def; range 0: none. The handle stays. A closed latch stays closed if it is at the same place. */
    jointSetLatch(joint: Given<hh_joint>, at: number, range: number, strength: number): void;
    jointSetFriction(joint: Given<hh_joint>, friction: number): void;
    /** State after the last step; null outputs are skipped. A hinge counts full turns. */
    jointState(joint: Given<hh_joint>): { coordinate: number; speed: number; latched: boolean };
    /** The contacts of the last step, in a fixed order: pairs that have come within 0.1 mm, or between which an impulse acted. Empty after a restore and after hh_world_step_simulated. `count` gets their number; HH_ERROR_CAPACITY if it is more than `capacity`. */
    contacts(): hh_contact[];
    /** First surface that the segment hits, from outside or inside; distance_m: from `from`. `skip`: a player whose head counts as not there; null: none. Coordinates within 1e9 m. */
    castRay(from: Given<hh_vec3>, to: Given<hh_vec3>, skip: Given<hh_player>): hh_hit;
    /** First impact of a sphere that moves along the segment. Radius in [1e-6, 1e4] m; distance_m: how far its centre has moved, 0 if it touches something at the start. */
    castSphere(radius_m: number, from: Given<hh_vec3>, to: Given<hh_vec3>, skip: Given<hh_player>): hh_hit;
    /** Nearest surface point within max_distance_m of the point, [0, 1e4]; distance_m: 0 inside a solid, where the normal points outward. */
    closestPoint(point: Given<hh_vec3>, max_distance_m: number, skip: Given<hh_player>): hh_hit;
    /** Everything that a sphere touches: the nearest point of each body and head to its centre, in a fixed order. Inside a solid distance_m is 0 and the normal points outward. `count` gets their number; HH_ERROR_CAPACITY if it is more than `capacity`. Radius in [0, 1e4] m. */
    overlapSphere(center: Given<hh_vec3>, radius_m: number, skip: Given<hh_player>): hh_hit[];
    playerAdd(def: Given<hh_player_def> | null): hh_player;
    playerRemove(player: Given<hh_player>): void;
    playerIsValid(player: Given<hh_player>): boolean;
    players(): hh_player[];
    /** The headset's runtime, or the host, has recentred: from the next sample on, poses are given in a space that lies at `new_in_old` in the space before (OpenXR: poseInPreviousSpace). It turns about +Y only, else HH_ERROR_VALUE: x and z of the quaternion within 0.001. Before the player's first sample there is nothing to recentre. View, hands and grips stay where they are in the world; hh_player_pose.origin changes at once, HH_EVENT_RECENTRED follows in the next step. From now on the host announces all recentrings, as after hh_player_set_recenter_guess(world, player, 0). */
    playerRecenter(player: Given<hh_player>, new_in_old: Given<hh_pose>): void;
    /** `guesses` 1, the default: if head and hands jump by one turn about +Y and one translation, or the head by more than tracking.max_jump_m, the runtime has recentred, and nothing in the world moves. 0: the host announces recentrings, and every other jump is meant, such as a turn that the host puts into its samples: view and hands follow it, and gripping hands take new anchors. Part of the state. */
    playerSetRecenterGuess(player: Given<hh_player>, guesses: boolean): void;
    /** Moves the play space at once; it is then at rest relative to the scene. Dynamic bodies in the hands that no joint holds come along; hands let go of everything else, and hands of other players let go of this player and of those bodies. */
    playerTeleport(player: Given<hh_player>, origin: Given<hh_pose>): void;
    playerVelocity(player: Given<hh_player>): hh_vec3;
    playerSetVelocity(player: Given<hh_player>, velocity_mps: Given<hh_vec3>): void;
    /** The velocity that counts as rest for the player: that of the body last gripped, at the gripped point, else the scene's. A player feels the speed relative to it: for vignettes and wind. */
    playerReferenceVelocity(player: Given<hh_player>): hh_vec3;
    /** How far contacts moved the play space in the last step, against its hands and its velocity. */
    playerPushBack(player: Given<hh_player>): number;
    /** hh_player_def.mass_kg. */
    playerMass(player: Given<hh_player>): number;
    /** The sphere with which the head collides, in the world. Null outputs are skipped. is_tracked: false before the head's first sample, and while it is lost or inferred. */
    playerHead(player: Given<hh_player>): { center: hh_vec3; radius_m: number; is_tracked: boolean };
    /** The measures times the player's scale, in the world's metres: those given or measured in a T-pose, else what is believed of the player's size by now. */
    playerMeasures(player: Given<hh_player>): hh_measures;
    /** Replaces the measures, which are then no longer estimated. `measures`, not null: times the player's scale, each in [0.05, 5] m times the scale. */
    playerSetMeasures(player: Given<hh_player>, measures: Given<hh_measures>): void;
    playerSetUserData(player: Given<hh_player>, user_data: bigint): void;
    playerUserData(player: Given<hh_player>): bigint;
    /** Sets the hand's wrist in the frame of hh_tracking_sample.hands: identity if the samples are wrists with OpenXR's axes (-Z to the fingers, +Y the back of the hand). The pose is in the world's metres, like the samples, and does not scale with the player; within 10 m. Null: the default, which is the tuning's hand.controller_ numbers, for a controller's grip pose, times the player's scale. */
    playerSetHandInController(player: Given<hh_player>, side: number, hand_in_controller: Given<hh_pose> | null): void;
    /** Returns the wrist in the frame of the player's samples, in the world's metres: the pose set by hh_player_set_hand_in_controller or, without one, the tuning's times the player's scale. For hosts that have wrists and need controllers. */
    playerHandInController(player: Given<hh_player>, side: number): hh_pose;
    /** Returns the tuning's pose of the wrist in a controller. Players of scale 1 without a pose of their own have it. */
    handInController(side: number): hh_pose;
    /** One hand. `hand_size`: bytes of hh_hand_state as the host knows it. */
    playerHand(player: Given<hh_player>, side: number): hh_hand_state;
    /** True if the player can pull on what the hand grips: something static, kinematic or heavy, another player, or a body that joints connect to something fixed, such as a lever. False if the hand is empty, or what it holds comes along. */
    handMovesPlayer(player: Given<hh_player>, side: number): boolean;
    /** Poses of many players in one call; HH_ERROR_HANDLE, and nothing written, if one is stale. `pose_size`, `hand_size`: bytes of hh_player_pose and hh_hand_state as the host knows them. */
    playerPoses(players: Given<hh_player>[]): hh_player_pose[];
    /** In the next step the hand grips `body` where both are, at any distance, whatever the grab rules say; only a body for two hands needs an order for both. No grip begins while the player opens the hand. It holds until hh_hand_release or until the player opens the hand. If the player closes the hand before that, it grips what is in reach instead; with nothing in reach, the grip stays. HH_ERROR_STATE for a hand that was never tracked. */
    handGrip(player: Given<hh_player>, side: number, body: Given<hh_body>): void;
    /** In the next step the hand lets go, without a throw. It grips again when the player opens and closes it. HH_OK also for an empty hand. */
    handRelease(player: Given<hh_player>, side: number): void;
    /** The events of the last step, in a fixed order. Valid until the next step, restore, destroy or call of this function. `event_size`: bytes of hh_event as the host knows it; the list's elements lie so far apart. */
    events(): hh_event[];
    /** The shown hand's joints. `joints`: HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name. */
    playerHandJoints(player: Given<hh_player>, side: number, space: number): hh_hand_joint[];
    /** `joints`: HH_BODY_JOINT_COUNT elements. */
    playerBodyJoints(player: Given<hh_player>, space: number): hh_pose[];
    /** The player's hand gets the proportions of the skeleton in a glTF file (.glb, or .gltf with its data inside) whose joints have WebXR's or OpenXR's names. Null bytes: the built-in hand. HH_ERROR_DATA says what the file lacks. */
    playerSetHandRig(player: Given<hh_player>, side: number, gltf: Uint8Array | string | null): void;
    /** The player's body drives a humanoid skeleton from a glTF file; the table of a VRM file says which joint is which. Null bytes: none. */
    playerSetBodyRig(player: Given<hh_player>, gltf: Uint8Array | string | null): void;
    /** hh_player_set_body_rig for a skeleton as an array, of an engine that has no glTF file: 1 to 1024 joints, in any order. In other axes: handhold/convert.h. No joints: none. The tracked head lies between the eyes: at joints below the head whose names end in "eye", "eyes", "eye_l", "eye_r", "eye.l" or "eye.r", in any case, else estimated from the head's joint and its children. HH_ERROR_VALUE for parents that do not exist or form a ring; HH_ERROR_DATA says by name or index which joints are missing or implausible. */
    playerSetBodySkeleton(player: Given<hh_player>, joints: Given<hh_skeleton_joint>[], space: number): void;
    /** Joints of the player's body rig, in the order in which they were given. Fingers follow the shown hand's; a figure with both hands' fingers needs no second pair of hands (hh_player_skeleton_fingers). HH_ERROR_STATE without a rig. */
    playerSkeleton(player: Given<hh_player>, space: number): hh_pose[];
    /** Name and parent (-1: none) of one of these joints. The name is valid while the rig is set. */
    playerSkeletonJoint(player: Given<hh_player>, joint: number): { name: string; parent: number };
    /** Number of fingers of a hand of the body rig that follow the shown hand's, 0 to 5: 0 is a figure whose hands the host draws by hh_player_hand_joints. */
    playerSkeletonFingers(player: Given<hh_player>, side: number): number;
    /** Adds an authored grip to a body: hands that close near it take it. HH_ERROR_STATE if the body has 4 already. */
    bodyAddGrip(body: Given<hh_body>, def: Given<hh_grip_def> | null): void;
    /** From now on hands, trunks and legs ask the host, not the world's shapes. Null: back to the shapes. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. */
    setSurfaceQuery(query: Given<hh_surface_query> | null): void;
    /** The triangles that palm and fingers close on, in the body's frame; null: none. Not needed for gripping. The body must have no shape. HH_ERROR_STATE if it has, or if the mesh or the world was made without fits_hands. */
    bodySetSurface(body: Given<hh_body>, mesh: Mesh | null): void;
    /** Where bodies are now, after the host's own step. Unlike a teleport it ends no grip. A kinematic body rests there until hh_body_move_kinematic says where it will be at the end of the next step. Places all or, on an error, none. HH_ERROR_VALUE for a body that is there twice. */
    placeBodies(motions: Given<hh_body_motion>[]): void;
    /** Where a player's hh_player_pose.origin is now, and its velocity, by the host's locomotion. Unlike a teleport it ends no grip. */
    playerPlace(player: Given<hh_player>, origin: Given<hh_pose>, velocity_mps: Given<hh_vec3>): void;
    /** The hand holds `body` from now on; a null id: nothing. `anchor`: the wrist in the body's frame; null: where both are now, HH_ERROR_STATE for a hand that was never tracked. For hosts that use hh_world_step_hands only: the other steps keep the hold and let the hand pull the player. */
    handHold(player: Given<hh_player>, side: number, body: Given<hh_body>, anchor: Given<hh_pose> | null): void;
    /** What the hand would grip if it closed where it is, by the rules of hands that pull players: reach, sight, grab rules, authored grips. A null body: nothing, or another player. distance_m: from the palm. In every kind of world. HH_ERROR_STATE for a hand that was never tracked. */
    handFindGrip(player: Given<hh_player>, side: number): hh_surface_hit;
    /** One frame: reads tracking and shows hands and bodies where the host put them. It moves neither players nor bodies, and buttons do nothing: place bodies by hh_world_place_bodies. A move ordered by hh_body_move_kinematic waits for the next step of another kind. Cost: that of hh_world_step without physics. */
    stepHands(dt_s: number, inputs: Given<hh_player_input>[]): void;
    /** First half of a step: tracking, grips and constraints. Bodies must be placed where they are. Until hh_world_end_step, HH_ERROR_STATE for adding or removing bodies, joints and players, for teleporting, saving and other steps; hh_world_restore forgets the begun step. */
    beginStep(dt_s: number, inputs: Given<hh_player_input>[]): void;
    /** Constraints of the begun step: at most one per hand, in the order in which hands were added. Valid until hh_world_end_step. */
    handConstraints(): hh_hand_constraint[];
    /** One entry per player, in the order of hh_world_players. Valid until hh_world_end_step. */
    playerMotions(): hh_player_motion[];
    /** Second half, after the host's solver. `players`: the solved play spaces; one left out moves as predicted, HH_ERROR_VALUE for one that is there twice. Bodies that the host has not placed since hh_world_begin_step rest where they were. Releases grips, limits velocities and shows hands and bodies. On an error the step stays begun. */
    endStep(players: Given<hh_solved_player>[]): void;
    /** Velocities that the host must give its bodies: after hh_world_begin_step those of bodies that the distance grab pulls, after hh_world_end_step those of thrown and limited bodies. Players': hh_player_velocity. Valid until the next step. */
    velocityChanges(): hh_velocity_change[];
    /** After hh_world_step: dynamic bodies that hands hold, and those that joints connect to them. The host makes its own kinematic, takes pose and velocity from here, and places all others before the next step. They touch nothing of the host's, but push what its solver pushes. */
    heldBodies(): hh_body[];
}

/** Every function of a match, as a method. They throw a HandholdError if the library refuses the call. */
export declare class MatchCalls {
    /** How often to call hh_match_advance for so much time of the local clock since the last call, [0, 8]: a little more or less than its share, so that inputs reach the server just before they are needed. A spectator stays 9 ticks behind what has come. */
    ticksDue(elapsed_s: number): number;
    /** Goes back to the first wrong guess, if there is one, steps again to the present, and then one tick on. `input`, not null. `advanced` gets false, and the input is dropped, while the world is 62 ticks ahead of the last confirmed tick. Each tick stepped again costs about a quarter of a shown step: docs/reference/matches.md has figures. A spectator steps the next confirmed tick, or gets false if its inputs have not come; of `input` it takes only is_hidden. */
    advance(input: Given<hh_match_input>): boolean;
    /** Takes a packet of the server; a spectator those of hh_match_confirmed_inputs. HH_ERROR_DATA, and no change, for bytes that are damaged or not of this match. Packets that came too late or out of order are HH_OK: what they lack comes again. Both are counted in hh_match_stats.refused. Tolerates any bytes. */
    receive(packet: Uint8Array | string | null): void;
    /** Clients only. Writes the next packet to the server, `size` bytes. Call once a tick or once in two. A null `buffer` asks for the most bytes that a packet has, HH_MATCH_PACKET_BYTES; HH_ERROR_CAPACITY for a smaller `capacity`. */
    packet(): Uint8Array;
    /** Replaces the world's state by the one of hh_match_state, over a reliable stream of yours. Set your own state to the server's of the same tick before the next hh_match_advance. HH_ERROR_DATA, and no change, for other bytes. Tolerates any bytes. */
    join(bytes: Uint8Array | string | null): void;
    /** Somebody plays the slot, or nobody does: then its hands let go and its body floats. At first nobody plays any slot. */
    connect(slot: number): void;
    disconnect(slot: number): void;
    /** Takes a packet that came from that slot's player, at `now_s` on the server's clock. As hh_match_receive; a packet of another slot is HH_ERROR_DATA. The checksum in it finds damage, not forgery: your transport authenticates. */
    receiveFrom(slot: number, now_s: number, packet: Uint8Array | string | null): void;
    /** Confirms and steps the ticks whose inputs are complete, or which have ended on the server's clock; missing inputs are filled by a guess that all machines share. At most 16 a call; `ticks` gets the number. Call several times a tick. Null output: skipped. */
    confirm(now_s: number): number;
    /** Writes the next packet to that slot's player. As hh_match_packet. */
    packetTo(slot: number): Uint8Array;
    /** Writes the state that a player joins with, `size` bytes, for hh_match_join; send your own state of this tick with it. From now on the player is sent the inputs after it. As hh_world_save; with a null `buffer` nothing changes. HH_MATCH_NO_SLOT: the state for a spectator, who is sent the confirmed inputs after the present tick. */
    state(slot: number): Uint8Array;
    /** Steps one tick with an input for each slot, then goes back sync_ticks and steps again. */
    syncTest(inputs: Given<hh_match_input>[]): hh_match_difference;
    /** Writes the inputs of all slots in the confirmed ticks after `after`, for hh_match_receive of spectators: over a reliable stream of yours, or into a file, which then has the whole match. `until` gets the last tick written, `after` if there is nothing new: 128 ticks at most, and fewer if the buffer is full. Every 90th tick carries its hash, which the reader compares. HH_ERROR_VALUE if `after` is later than the last confirmed tick, or too early: 320 ticks are always kept, at most 448. A spectator then needs a state. A null `buffer` asks for HH_MATCH_INPUTS_BYTES; HH_ERROR_CAPACITY for less. */
    confirmedInputs(after: bigint): { buffer: Uint8Array; until: bigint };
    /** A player needs hh_match_state and hh_match_join: the world differs from the server's, or inputs are lost for good. A client answers for its own slot only, a spectator for any. */
    needsState(slot: number): boolean;
    /** Hash of world and game after a tick: equal on all machines if the tick is confirmed. HH_ERROR_VALUE unless it is the present one or, on a client, one of the 63 before that it has stepped. */
    hash(tick: bigint): bigint;
    /** Add these to the drawn positions of a slot's player, so that a corrected guess moves them within 0.08 s and not at once: to head and body, and to each hand with what it holds. m, world axes. For the own slot `head` is for the view too, with hands that hold nothing: it moves when others pull at what you hold. Only for pictures. Zero for servers, spectators and sync tests. */
    shownOffsets(slot: number): { head: hh_vec3; left: hh_vec3; right: hh_vec3 };
    /** Where to draw a slot's player between two ticks, for displays of another rate than the tick's: at the time up to which hh_match_ticks_due has been called, less one tick, which lies between the last two shown ticks. Call after the ticks of a picture. With hh_match_shown_offsets already. World poses: `origin` is the space of the samples, for the camera rig; `head`; and wrists to draw. A play space that moves by more than 0.5 m or turns by more than 0.2 rad at once, as by a teleport or a snap turn, is not drawn in between. While the world waits, everything stands still. `newest`, for the own slot: the devices at the time of the picture, of any time_s. Head and empty hands are then drawn where they are, and not late. Null: between ticks, as everything else. Fingers go with their wrist; arms, spine and legs with the head. Never changes the world. HH_ERROR_VALUE if `newest` is given for another slot, or to a spectator. Clients and spectators. HH_ERROR_STATE before the first shown tick, and after hh_match_join. */
    drawnPlayer(slot: number, newest: Given<hh_tracking_sample> | null): { origin: hh_pose; head: hh_pose; left: hh_pose; right: hh_pose };
    /** The same for bodies: poses as of hh_world_body_poses. A body that is held goes with its hands; one that moves by more than 0.5 m at once is not drawn in between. */
    drawnBodies(bodies: Given<hh_body>[]): hh_pose[];
    /** What the last hh_match_advance, hh_match_confirm, hh_match_join or hh_match_sync_test found, in the order of finding. Servers and sync tests have confirmed events only. Valid until the next call of these or of this function. `event_size`: bytes of hh_match_event as the host knows it; the list's elements lie so far apart. */
    events(): hh_match_event[];
    getStats(): hh_match_stats;
}
