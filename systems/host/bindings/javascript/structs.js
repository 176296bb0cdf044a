// Made from the C headers by systems/host/bindings/generate.py; do not edit.
export const HANDHOLD_VERSION_MAJOR = 0;
export const HANDHOLD_VERSION_MINOR = 2;
export const HANDHOLD_VERSION_PATCH = 0;
export const HANDHOLD_VERSION_TEXT = "0.2.0";
export const HH_HAND_JOINT_COUNT = 26;
export const HH_IS_BY_NAME = 0;
export const HH_IS_BODY = 100;
export const HH_IS_LEFT_HAND = 200;
export const HH_IS_RIGHT_HAND = 300;
export const HH_MATCH_PLAYERS = 16;
export const HH_MATCH_PACKET_BYTES = 1200;
export const HH_MATCH_INPUTS_BYTES = 8192;
export const HH_MATCH_NO_SLOT = 4294967295;
export const HH_MATCH_PLACES = 64;
export const HH_MATCH_REFUSALS = 16;
export const HH_OK = 0;
export const HH_ERROR_NULL = 1;
export const HH_ERROR_VERSION = 2;
export const HH_ERROR_HANDLE = 3;
export const HH_ERROR_VALUE = 4;
export const HH_ERROR_NAME = 5;
export const HH_ERROR_STATE = 6;
export const HH_ERROR_CAPACITY = 7;
export const HH_ERROR_DATA = 8;
export const HH_ERROR_MEMORY = 9;
export const HH_ERROR_INTERNAL = 10;
export const HH_LEFT = 0;
export const HH_RIGHT = 1;
export const HH_LOG_NOTE = 0;
export const HH_LOG_ERROR = 1;
export const HH_ENGINE_UNITY = 0;
export const HH_ENGINE_UNREAL = 1;
export const HH_ENGINE_GODOT = 2;
export const HH_MOMENTUM_BODIES = 0;
export const HH_MOMENTUM_PLAYERS = 1;
export const HH_MOMENTUM_DISCARDED = 2;
export const HH_MOMENTUM_STATICS = 3;
export const HH_MOMENTUM_RECEIVERS = 4;
export const HH_STATIC = 0;
export const HH_KINEMATIC = 1;
export const HH_DYNAMIC = 2;
export const HH_BALL = 0;
export const HH_HINGE = 1;
export const HH_SLIDER = 2;
export const HH_FIXED = 3;
export const HH_DISTANCE = 4;
export const HH_MOTOR_NONE = 0;
export const HH_MOTOR_SPEED = 1;
export const HH_MOTOR_POSITION = 2;
export const HH_GRIP_NONE = 0;
export const HH_GRIP_SURFACE = 1;
export const HH_GRIP_HELD = 2;
export const HH_GRIP_AUTHORED = 3;
export const HH_GRIP_PLAYER = 4;
export const HH_EVENT_TOUCHED = 0;
export const HH_EVENT_GRABBED = 1;
export const HH_EVENT_RELEASED = 2;
export const HH_EVENT_REFUSED = 3;
export const HH_EVENT_SLIPPED = 4;
export const HH_EVENT_CONTACT_BEGAN = 5;
export const HH_EVENT_CONTACT_ENDED = 6;
export const HH_EVENT_LATCH_CLOSED = 7;
export const HH_EVENT_LATCH_OPENED = 8;
export const HH_EVENT_LIMIT_REACHED = 9;
export const HH_EVENT_RECENTRED = 10;
export const HH_REASON_NONE = 0;
export const HH_REASON_OPENED = 1;
export const HH_REASON_NO_SURFACE = 2;
export const HH_REASON_NOT_ALLOWED = 3;
export const HH_REASON_NEEDS_TWO_HANDS = 4;
export const HH_REASON_STRETCHED = 5;
export const HH_REASON_TRACKING_LOST = 6;
export const HH_REASON_BODY_GONE = 7;
export const HH_REASON_BY_HOST = 8;
export const HH_REASON_OTHER_HAND = 9;
export const HH_SPACE_WORLD = 0;
export const HH_SPACE_PARENT = 1;
export const HH_HAND_PALM = 0;
export const HH_HAND_WRIST = 1;
export const HH_THUMB_METACARPAL = 2;
export const HH_THUMB_PROXIMAL = 3;
export const HH_THUMB_DISTAL = 4;
export const HH_THUMB_TIP = 5;
export const HH_INDEX_METACARPAL = 6;
export const HH_INDEX_PROXIMAL = 7;
export const HH_INDEX_INTERMEDIATE = 8;
export const HH_INDEX_DISTAL = 9;
export const HH_INDEX_TIP = 10;
export const HH_MIDDLE_METACARPAL = 11;
export const HH_MIDDLE_PROXIMAL = 12;
export const HH_MIDDLE_INTERMEDIATE = 13;
export const HH_MIDDLE_DISTAL = 14;
export const HH_MIDDLE_TIP = 15;
export const HH_RING_METACARPAL = 16;
export const HH_RING_PROXIMAL = 17;
export const HH_RING_INTERMEDIATE = 18;
export const HH_RING_DISTAL = 19;
export const HH_RING_TIP = 20;
export const HH_LITTLE_METACARPAL = 21;
export const HH_LITTLE_PROXIMAL = 22;
export const HH_LITTLE_INTERMEDIATE = 23;
export const HH_LITTLE_DISTAL = 24;
export const HH_LITTLE_TIP = 25;
export const HH_HIPS = 0;
export const HH_SPINE = 1;
export const HH_CHEST = 2;
export const HH_UPPER_CHEST = 3;
export const HH_NECK = 4;
export const HH_HEAD = 5;
export const HH_LEFT_SHOULDER = 6;
export const HH_LEFT_UPPER_ARM = 7;
export const HH_LEFT_LOWER_ARM = 8;
export const HH_LEFT_HAND = 9;
export const HH_RIGHT_SHOULDER = 10;
export const HH_RIGHT_UPPER_ARM = 11;
export const HH_RIGHT_LOWER_ARM = 12;
export const HH_RIGHT_HAND = 13;
export const HH_LEFT_UPPER_LEG = 14;
export const HH_LEFT_LOWER_LEG = 15;
export const HH_LEFT_FOOT = 16;
export const HH_RIGHT_UPPER_LEG = 17;
export const HH_RIGHT_LOWER_LEG = 18;
export const HH_RIGHT_FOOT = 19;
export const HH_BODY_JOINT_COUNT = 20;
export const HH_ROWS_POINT = 0;
export const HH_ROWS_WELD = 1;
export const HH_ROWS_DIRECTION = 2;
export const HH_MATCH_CLIENT = 0;
export const HH_MATCH_SERVER = 1;
export const HH_MATCH_SYNC_TEST = 2;
export const HH_MATCH_SPECTATOR = 3;
export const HH_MATCH_PREDICTED = 0;
export const HH_MATCH_CONFIRMED = 1;
export const HH_MATCH_RETRACTED = 2;
export const HH_MATCH_REFUSED_SIZE = 1;
export const HH_MATCH_REFUSED_CHECKSUM = 2;
export const HH_MATCH_REFUSED_VERSION = 3;
export const HH_MATCH_REFUSED_SENDER = 4;
export const HH_MATCH_REFUSED_MALFORMED = 5;
export const HH_MATCH_REFUSED_GAP = 6;
export const HH_MATCH_REFUSED_WINDOW = 7;
export const HH_MATCH_REFUSED_STATE = 8;
// By struct: [field, kind, length of an array inside, more about lists and callbacks].
export const structs = {
    hh_vec3: [["x", "f64"], ["y", "f64"], ["z", "f64"]],
    hh_quat: [["x", "f64"], ["y", "f64"], ["z", "f64"], ["w", "f64"]],
    hh_pose: [["position", "hh_vec3"], ["rotation", "hh_quat"]],
    hh_finger_curls: [["fingers", "f64", 5]],
    hh_shape: [["index", "u32"], ["generation", "u32"]],
    hh_body: [["index", "u32"], ["generation", "u32"]],
    hh_joint: [["index", "u32"], ["generation", "u32"]],
    hh_player: [["index", "u32"], ["generation", "u32"]],
    hh_host_hooks: [["struct_size", "u32"], ["context", "pointer"], ["log", "callback", 0, {"returns": "void", "params": [["context", "pointer"], ["value", "i32"], ["text", "text"]]}], ["assert_failed", "callback", 0, {"returns": "void", "params": [["context", "pointer"], ["text", "text"]]}], ["parallel_for", "callback", 0, {"returns": "void", "params": [["context", "pointer"], ["value", "u32"], ["task", "pointer"], ["task_context", "pointer"]]}], ["thread_count", "u32"]],
    hh_world_def: [["struct_size", "u32"], ["fits_hands", "bool"], ["reports_touches", "bool"], ["gravity_mps2", "hh_vec3"], ["reference_velocity_mps", "hh_vec3"]],
    hh_tracking_sample: [["struct_size", "u32"], ["time_s", "f64"], ["head", "hh_pose"], ["hands", "hh_pose", 2], ["head_tracked", "bool"], ["hand_tracked", "bool", 2], ["grab", "bool", 2], ["squeeze", "f64", 2], ["trigger", "f64", 2], ["head_inferred", "bool"], ["hand_inferred", "bool", 2], ["curls", "hh_finger_curls", 2]],
    hh_commands: [["smooth_turn", "f64"], ["snap_turns", "i32"], ["brake", "f64"], ["thrust", "hh_vec3"], ["calibrate", "bool"]],
    hh_player_input: [["struct_size", "u32"], ["player", "hh_player"], ["samples", "list", 0, {"of": "hh_tracking_sample", "count": "sample_count", "each": 1}], ["sample_count", "u32"], ["repeats_samples", "bool"], ["commands", "hh_commands"]],
    hh_momentum: [["linear_kgmps", "hh_vec3", 4], ["angular_kgm2ps", "hh_vec3", 4]],
    hh_world_stats: [["struct_size", "u32"], ["bodies", "u64"], ["joints", "u64"], ["players", "u64"], ["shapes", "u64"], ["contacts", "u64"], ["islands", "u64"], ["newton_iterations", "u64"], ["hand_error_m", "f64"], ["overlap_m", "f64"], ["joint_error_m", "f64"], ["step_us", "f64"], ["joint_error_rad", "f64"], ["islands_pushed", "u64"], ["contact_rounds", "u64"], ["hands_closed", "u64"], ["hands_gripped", "u64"], ["momentum", "hh_momentum"], ["deepest_a", "hh_body"], ["deepest_b", "hh_body"]],
    hh_tuning_info: [["struct_size", "u32"], ["name", "text"], ["unit", "text"], ["what", "text"], ["low", "f64"], ["high", "f64"], ["count", "u32"], ["scales", "bool"]],
    hh_compound_part: [["shape", "hh_shape"], ["pose", "hh_pose"], ["mass_kg", "f64"]],
    hh_mesh_def: [["struct_size", "u32"], ["positions", "list", 0, {"of": "f32", "count": "vertex_count", "each": 3}], ["vertex_count", "u32"], ["vertex_stride", "u32"], ["indices", "list", 0, {"of": "u32", "count": "index_count", "each": 1}], ["index_count", "u32"], ["fits_hands", "bool"]],
    hh_body_def: [["struct_size", "u32"], ["name", "text"], ["kind", "i32"], ["shape", "hh_shape"], ["pose", "hh_pose"], ["velocity_mps", "hh_vec3"], ["angular_velocity_radps", "hh_vec3"], ["mass_kg", "f64"], ["inertia_kgm2", "hh_vec3"], ["restitution", "f64"], ["friction", "f64"], ["gravity_scale", "f64"], ["layers", "u32"], ["mask", "u32"], ["grab_left", "bool"], ["grab_right", "bool"], ["grab_two_hands", "bool"], ["grab_priority", "i32"], ["user_data", "u64"]],
    hh_joint_def: [["struct_size", "u32"], ["name", "text"], ["kind", "i32"], ["body_a", "hh_body"], ["body_b", "hh_body"], ["frame", "hh_pose"], ["point_b", "hh_vec3"], ["collides", "bool"], ["limited", "bool"], ["lower", "f64"], ["upper", "f64"], ["friction", "f64"], ["detent_spacing", "f64"], ["detent_strength", "f64"], ["latch_at", "f64"], ["latch_range", "f64"], ["latch_strength", "f64"], ["latch_handle", "hh_joint"], ["latch_handle_at", "f64"]],
    hh_motor_def: [["struct_size", "u32"], ["kind", "i32"], ["speed", "f64"], ["position", "f64"], ["time_s", "f64"], ["strength", "f64"]],
    hh_contact: [["body_a", "hh_body"], ["body_b", "hh_body"], ["player_a", "hh_player"], ["player_b", "hh_player"], ["point", "hh_vec3"], ["normal", "hh_vec3"], ["depth_m", "f64"], ["impulse_ns", "f64"]],
    hh_hit: [["body", "hh_body"], ["player", "hh_player"], ["point", "hh_vec3"], ["normal", "hh_vec3"], ["distance_m", "f64"]],
    hh_measures: [["eye_height_m", "f64"], ["shoulder_width_m", "f64"], ["upper_arm_m", "f64"], ["forearm_m", "f64"]],
    hh_player_def: [["struct_size", "u32"], ["name", "text"], ["origin", "hh_pose"], ["velocity_mps", "hh_vec3"], ["mass_kg", "f64"], ["measures", "hh_measures"], ["scale", "f64"], ["head_collides", "bool"], ["layers", "u32"], ["mask", "u32"], ["grab_layers", "u32"], ["user_data", "u64"]],
    hh_hand_state: [["grip", "i32"], ["body", "hh_body"], ["other", "hh_player"], ["tracked", "hh_pose"], ["shown", "hh_pose"], ["anchor", "hh_pose"], ["error_m", "f64"], ["force_impulse_ns", "hh_vec3"], ["is_tracked", "bool"], ["is_closed", "bool"], ["is_inferred", "bool"]],
    hh_player_pose: [["origin", "hh_pose"], ["head", "hh_pose"], ["velocity_mps", "hh_vec3"], ["hands", "hh_hand_state", 2]],
    hh_event: [["kind", "i32"], ["reason", "i32"], ["player", "hh_player"], ["side", "i32"], ["body", "hh_body"], ["other", "hh_player"], ["held", "hh_body"], ["joint", "hh_joint"], ["position", "hh_vec3"], ["impulse_ns", "f64"]],
    hh_hand_joint: [["pose", "hh_pose"], ["radius_m", "f64"], ["is_valid", "bool"]],
    hh_skeleton_joint: [["name", "text"], ["parent", "i32"], ["is", "i32"], ["bind", "hh_pose"]],
    hh_finger: [["is_posed", "bool"], ["curl_rad", "f64", 3], ["opposition_rad", "f64"], ["follows_trigger", "bool"], ["pressed_curl_rad", "f64", 3], ["pressed_opposition_rad", "f64"]],
    hh_grip_hand: [["is_used", "bool"], ["wrist", "hh_pose"], ["fingers", "hh_finger", 5]],
    hh_grip_def: [["struct_size", "u32"], ["hands", "hh_grip_hand", 2], ["priority", "i32"], ["snap_radius_m", "f64"], ["snap_angle_rad", "f64"]],
    hh_surface_hit: [["body", "hh_body"], ["point", "hh_vec3"], ["normal", "hh_vec3"], ["distance_m", "f64"]],
    hh_surface_query: [["struct_size", "u32"], ["context", "pointer"], ["cast_ray", "callback", 0, {"returns": "bool", "params": [["context", "pointer"], ["value", "hh_vec3"], ["value", "hh_vec3"], ["array", "hh_body"], ["count", "u32"], ["out", "hh_surface_hit"]]}], ["cast_sphere", "callback", 0, {"returns": "bool", "params": [["context", "pointer"], ["value", "f64"], ["value", "hh_vec3"], ["value", "hh_vec3"], ["array", "hh_body"], ["count", "u32"], ["out", "hh_surface_hit"]]}], ["closest_point", "callback", 0, {"returns": "bool", "params": [["context", "pointer"], ["value", "hh_vec3"], ["value", "f64"], ["array", "hh_body"], ["count", "u32"], ["out", "hh_surface_hit"]]}], ["closest_point_on", "callback", 0, {"returns": "bool", "params": [["context", "pointer"], ["value", "hh_body"], ["value", "hh_vec3"], ["out", "hh_surface_hit"]]}]],
    hh_body_motion: [["body", "hh_body"], ["pose", "hh_pose"], ["velocity_mps", "hh_vec3"], ["angular_velocity_radps", "hh_vec3"]],
    hh_hand_constraint: [["player", "hh_player"], ["side", "i32"], ["body", "hh_body"], ["rows", "i32"], ["anchor", "hh_pose"], ["target", "hh_pose"], ["velocity_mps", "hh_vec3"], ["angular_velocity_radps", "hh_vec3"], ["body_rotation", "hh_quat"], ["body_angular_velocity_radps", "hh_vec3"], ["anchor_end", "hh_pose"], ["compliance_m_per_n", "f64"], ["max_force_n", "f64"], ["is_releasing", "bool"]],
    hh_player_motion: [["player", "hh_player"], ["origin", "hh_vec3"], ["velocity_mps", "hh_vec3"], ["mass_kg", "f64"], ["head", "hh_pose"], ["head_radius_m", "f64"]],
    hh_solved_player: [["player", "hh_player"], ["origin", "hh_vec3"], ["velocity_mps", "hh_vec3"]],
    hh_velocity_change: [["body", "hh_body"], ["velocity_mps", "hh_vec3"], ["angular_velocity_radps", "hh_vec3"]],
    hh_match_def: [["struct_size", "u32"], ["role", "i32"], ["players", "list", 0, {"of": "hh_player", "count": "player_count", "each": 1}], ["player_count", "u32"], ["tick_s", "f64"], ["slot", "u32"], ["sync_ticks", "u32"], ["start_s", "f64"]],
    hh_match_game: [["struct_size", "u32"], ["context", "pointer"], ["step", "callback", 0, {"returns": "void", "params": [["context", "pointer"], ["value", "u64"], ["array", "u32"], ["count", "u32"]]}], ["save", "callback", 0, {"returns": "void", "params": [["context", "pointer"], ["value", "u32"]]}], ["restore", "callback", 0, {"returns": "void", "params": [["context", "pointer"], ["value", "u32"]]}], ["hash", "callback", 0, {"returns": "u64", "params": [["context", "pointer"]]}]],
    hh_match_input: [["struct_size", "u32"], ["buttons", "u32"], ["samples", "list", 0, {"of": "hh_tracking_sample", "count": "sample_count", "each": 1}], ["sample_count", "u32"], ["is_hidden", "bool"], ["commands", "hh_commands"]],
    hh_match_difference: [["tick", "u64"], ["in_world", "bool"], ["in_game", "bool"]],
    hh_match_event: [["tick", "u64"], ["state", "i32"], ["event", "hh_event"]],
    hh_match_stats: [["struct_size", "u32"], ["tick", "u64"], ["confirmed", "u64"], ["ticks", "u64"], ["rollbacks", "u64"], ["steps_again", "u64"], ["deepest", "u64"], ["waits", "u64"], ["filled", "u64"], ["hashes", "u64"], ["out_of_sync", "u64"], ["refused", "u64", 16]],
};
