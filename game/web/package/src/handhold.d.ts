import type {
    Given, LibraryCalls, MatchCalls, Mesh, WorldCalls, hh_body, hh_body_def, hh_commands, hh_compound_part, hh_grip_def, hh_hand_joint,
    hh_joint, hh_joint_def, hh_match_def, hh_match_game, hh_mesh_def, hh_player, hh_player_def, hh_player_pose, hh_pose, hh_quat, hh_shape, hh_tracking_sample, hh_vec3,
    hh_world_def, hh_world_stats,
} from './structs.js';
export * from './structs.js';

export declare class HandholdError extends Error {
    constructor(result: number, text: string);
    /** HH_ERROR_... */
    readonly result: number;
}

/** Loads the library; without a source: handhold.wasm beside this module, to which relative paths refer. handhold-core.wasm is smaller and lacks what reads files
 * (glTF levels, rigs, clips, tuning), saved states and matches: their calls throw. */
export declare function loadHandhold(source?: URL | string | BufferSource | WebAssembly.Module): Promise<Handhold>;

/** Functions without a world. All of LibraryCalls are those of the C headers without hh_. */
declare const LibraryBase: new () => Omit<LibraryCalls, 'version'>;
export declare class Handhold extends LibraryBase {
    private constructor();
    version(): string;
    createWorld(definition?: Given<hh_world_def>): World;
    createMesh(mesh: Given<hh_mesh_def>): Mesh;
    destroyMesh(mesh: Mesh): void;
}

/** One player's input of one step. */
export interface PlayerInput {
    player: hh_player;
    /** Sorted by time: those since the last step. */
    samples?: Given<hh_tracking_sample>[];
    repeats_samples?: boolean;
    commands?: Given<hh_commands>;
}

/** Every function of a world is a method: hh_world_x as x, hh_body_x and the others as bodyX. Those below have short names, or
 * defaults. Methods throw a HandholdError when the library refuses a call, and a TypeError for arguments of a wrong type; the call then
 * changed nothing. What a callback throws is thrown when the call that made it has ended, which still takes effect. */
declare const WorldBase: new () => Omit<WorldCalls, 'bodyJoints' | 'getTuning' | 'setTuning' | 'step' | 'stepPoseOnly'>;
export declare class World extends WorldBase {
    private constructor();
    /** Not inside a callback or in a match: HH_ERROR_STATE. A second call does nothing. */
    destroy(): void;

    addBox(half_extents_m: hh_vec3): hh_shape;
    addSphere(radius_m: number): hh_shape;
    addCapsule(radius_m: number, half_height_m: number): hh_shape;
    addCylinder(radius_m: number, half_height_m: number): hh_shape;
    addHull(points: hh_vec3[]): hh_shape;
    addCompound(parts: Given<hh_compound_part>[]): hh_shape;
    addMeshShape(mesh: Mesh, scale?: hh_vec3): hh_shape;
    removeShape(shape: hh_shape): void;

    addBody(definition: Given<hh_body_def>): hh_body;
    removeBody(body: hh_body): void;
    findBody(name: string): hh_body;
    setBodyVelocity(body: hh_body, velocity_mps: hh_vec3, angular_velocity_radps?: hh_vec3): void;
    applyImpulse(body: hh_body, impulse_ns: hh_vec3, point: hh_vec3): void;
    teleportBody(body: hh_body, pose: { position?: hh_vec3; rotation?: hh_quat }): void;
    moveKinematic(body: hh_body, pose: { position?: hh_vec3; rotation?: hh_quat }): void;

    addJoint(definition: Given<hh_joint_def>): hh_joint;
    removeJoint(joint: hh_joint): void;

    addPlayer(definition?: Given<hh_player_def>): hh_player;
    removePlayer(player: hh_player): void;
    teleportPlayer(player: hh_player, origin: { position?: hh_vec3; rotation?: hh_quat }): void;
    setHandInController(player: hh_player, side: number, hand_in_controller: { position?: hh_vec3; rotation?: hh_quat } | null): void;
    playerPose(player: hh_player): hh_player_pose;
    /** 26 joints as WebXR and XR_EXT_hand_tracking have them, the palm first. */
    handJoints(player: hh_player, side: number, space: number): hh_hand_joint[];
    /** By HH_HIPS and the other constants. */
    bodyJoints(player: hh_player, space: number): hh_pose[];
    /** Hinges and other joints at a body. */
    bodyJoints(body: hh_body): hh_joint[];
    grip(player: hh_player, side: number, body: hh_body): void;
    releaseHand(player: hh_player, side: number): void;
    addGrip(body: hh_body, definition: Given<hh_grip_def>): void;
    setHandRig(player: hh_player, side: number, gltf: Uint8Array | null): void;
    /** A humanoid skeleton that the player's body drives; its bytes, .glb. */
    setBodyRig(player: hh_player, gltf: Uint8Array | null): void;
    /** Poses of that skeleton's joints, in the file's order. */
    skeleton(player: hh_player, space: number): hh_pose[];
    skeletonJoint(player: hh_player, joint: number): { name: string; parent: number };
    /** Number of fingers of a hand of the body rig that follow the shown hand's. */
    skeletonFingers(player: hh_player, side: number): number;

    /** Begins a match at the present tick. `game`: state of your own that goes back and forth with the world's. */
    createMatch(definition: Given<hh_match_def>, game?: Given<hh_match_game> | null): Match;

    step(dt_s: number, inputs?: PlayerInput[]): void;
    stepPoseOnly(dt_s: number, inputs?: PlayerInput[]): void;
    stats(): hh_world_stats;

    setTuning(name: string, ...values: number[]): void;
    getTuning(name: string, count?: number): number[];
}

/** A match in which a world takes part: every function of it is a method, hh_match_x as x. Your transport carries its packets. */
export declare class Match extends MatchCalls {
    private constructor();
    /** The world stays. Not inside a callback: HH_ERROR_STATE. Call it before the world's destroy(). A second call does nothing. */
    destroy(): void;
}
