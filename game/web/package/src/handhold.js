// Handhold in JavaScript: the C interface (handhold.h) with plain objects. Field names are those of
// its structs; vectors are {x, y, z}, rotations {x, y, z, w}, so three.js objects can be passed.
import { Memory, layoutOf } from './memory.js';

export * from './structs.js';

/** A call of the library that failed: `result` is the HH_ERROR_ number. */
export class HandholdError extends Error {
    constructor(result, text) {
        super(text);
        this.name = 'HandholdError';
        this.result = result;
    }
}

/** Loads the library. `source`: where handhold.wasm is, its bytes, or a compiled module; by default
 * the file beside this one. */
export async function loadHandhold(source = new URL('./handhold.wasm', import.meta.url)) {
    const system = systemCalls();
    const instance = await instantiate(source, system.imports);
    system.memory = instance.exports.memory;
    instance.exports._initialize?.();
    return new Handhold(instance.exports);
}

async function instantiate(source, imports) {
    if (source instanceof WebAssembly.Module) {
        return new WebAssembly.Instance(source, imports);
    }
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) {
        return (await WebAssembly.instantiate(source, imports)).instance;
    }
    const url = new URL(source, import.meta.url);
    if (url.protocol === 'file:') {
        const { readFile } = await import('node:fs/promises');
        return (await WebAssembly.instantiate(await readFile(url), imports)).instance;
    }
    const response = await fetch(url);
    if (!response.ok) {
        throw new Error(`${url}: ${response.status} ${response.statusText}`);
    }
    return (await WebAssembly.instantiate(await response.arrayBuffer(), imports)).instance;
}

// What the library asks of a system: a clock and, for texts of failed checks, an output. There are
// no files, arguments or variables.
function systemCalls() {
    const system = { memory: undefined, imports: undefined };
    const view = () => new DataView(system.memory.buffer);
    const badFile = () => 8;
    const wasi = {
        clock_time_get(id, precision, at) {
            const ms = id === 0 ? Date.now() : performance.now();
            view().setBigUint64(at, BigInt(Math.round(ms * 1e6)), true);
            return 0;
        },
        fd_write(file, vectors, count, written) {
            let text = '';
            let size = 0;
            for (let i = 0; i < count; ++i) {
                const at = view().getUint32(vectors + 8 * i, true);
                const length = view().getUint32(vectors + 8 * i + 4, true);
                text += new TextDecoder().decode(new Uint8Array(system.memory.buffer, at, length));
                size += length;
            }
            console.warn(text.trimEnd());
            view().setUint32(written, size, true);
            return 0;
        },
        environ_sizes_get(count, size) {
            view().setUint32(count, 0, true);
            view().setUint32(size, 0, true);
            return 0;
        },
        environ_get: () => 0,
        proc_exit(status) {
            throw new Error(`the library ended with status ${status}`);
        },
    };
    const others = (known) => new Proxy(known, { get: (functions, name) => functions[name] ?? badFile, has: () => true });
    system.imports = {
        wasi_snapshot_preview1: others(wasi),
        env: others({ emscripten_notify_memory_growth() {} }),
    };
    return system;
}

/** The library. */
export class Handhold {
    constructor(exports) {
        this.exports = exports;
        this.memory = new Memory(exports);
    }

    version() {
        return this.scratch((m) => {
            const at = m.take(12);
            this.exports.hh_version(at, at + 4, at + 8);
            return m.readList('u32', at, 3).join('.');
        });
    }
    createWorld(definition = {}) {
        return this.scratch((m) => {
            const out = m.take(4);
            this.check(this.exports.hh_world_create(this.definition('hh_world_def', definition), out));
            return new World(this, m.view.getUint32(out, true));
        });
    }
    /** A mesh for World.addMeshShape. `positions`: x, y, z of each vertex; `indices`: three a triangle. */
    createMesh({ positions, indices, fits_hands = true }) {
        return this.scratch((m) => {
            const out = m.take(4);
            const points = Float32Array.from(positions);
            const corners = Uint32Array.from(indices);
            const definition = this.definition('hh_mesh_def', {
                positions: m.takeBytes(points), vertex_count: points.length / 3,
                indices: m.takeBytes(corners), index_count: corners.length, fits_hands,
            });
            this.check(this.exports.hh_mesh_create(definition, out));
            return m.view.getUint32(out, true);
        });
    }
    destroyMesh(mesh) {
        this.exports.hh_mesh_destroy(mesh);
    }

    /** Runs work with scratch memory. */
    scratch(work) {
        try {
            return work(this.memory);
        } finally {
            this.memory.release();
        }
    }
    /** Fills a struct with the library's defaults. */
    fillDefault(kind, at) {
        this.check(this.exports[`hh_default_${kind.slice(3)}_sized`](at, layoutOf(kind).size));
    }
    /** A struct with the library's defaults and what `given` says. */
    definition(kind, given) {
        const at = this.memory.take(layoutOf(kind).size);
        this.fillDefault(kind, at);
        this.memory.write(kind, at, given);
        return at;
    }
    check(result) {
        if (result !== 0) {
            const name = this.memory.text(this.exports.hh_result_text(result));
            throw new HandholdError(result, `${name}: ${this.memory.text(this.exports.hh_last_error())}`);
        }
    }
}

/** A simulation. Ids are what its functions return; call destroy() when it is no longer needed. */
export class World {
    #library;
    #world;

    constructor(library, world) {
        this.#library = library;
        this.#world = world;
    }
    destroy() {
        this.#library.exports.hh_world_destroy(this.#world);
        this.#world = 0;
    }

    // Calls hh_<name>(world, ...words) with scratch memory; words are numbers or made by `make`.
    #call(name, make = () => []) {
        this.#library.scratch((m) => this.#checked(name, make(m)));
    }
    #checked(name, words) {
        this.#library.check(this.#library.exports['hh_' + name](this.#world, ...words));
    }
    // The same with an output behind the words.
    #get(name, kind, make = () => []) {
        return this.#library.scratch((m) => {
            const out = m.take(Math.max(layoutOf(kind).size, 8));
            this.#checked(name, [...make(m), out]);
            return m.read(kind, out);
        });
    }
    // A list whose length the library says in a first call.
    #list(name, kind, make = () => []) {
        return this.#library.scratch((m) => {
            const count = m.take(4);
            const words = make(m);
            this.#checked(name, [...words, 0, 0, count]);
            const size = m.view.getUint32(count, true);
            const at = m.take(size * layoutOf(kind).size);
            this.#checked(name, [...words, at, size, count]);
            return m.readList(kind, at, size);
        });
    }
    #poses(name, idKind, kind, ids, sizes = []) {
        return this.#library.scratch((m) => {
            const out = m.take(ids.length * layoutOf(kind).size);
            this.#checked(name, [m.takeList(idKind, ids), ids.length, out, ...sizes]);
            return m.readList(kind, out, ids.length);
        });
    }
    #one(m, kind, value) {
        const at = m.take(layoutOf(kind).size);
        m.write(kind, at, value);
        return at;
    }

    // ---- Shapes
    addBox(half_extents_m) {
        return this.#get('shape_add_box', 'hh_shape', (m) => [this.#one(m, 'hh_vec3', half_extents_m)]);
    }
    addSphere(radius_m) {
        return this.#get('shape_add_sphere', 'hh_shape', () => [radius_m]);
    }
    addCapsule(radius_m, half_height_m) {
        return this.#get('shape_add_capsule', 'hh_shape', () => [radius_m, half_height_m]);
    }
    addCylinder(radius_m, half_height_m) {
        return this.#get('shape_add_cylinder', 'hh_shape', () => [radius_m, half_height_m]);
    }
    addHull(points) {
        return this.#get('shape_add_hull', 'hh_shape', (m) => [m.takeList('hh_vec3', points), points.length]);
    }
    addCompound(parts) {
        return this.#get('shape_add_compound', 'hh_shape', (m) => [m.takeList('hh_compound_part', parts.map(withPose)), parts.length]);
    }
    addMeshShape(mesh, scale = { x: 1, y: 1, z: 1 }) {
        return this.#get('shape_add_mesh', 'hh_shape', (m) => [mesh, this.#one(m, 'hh_vec3', scale)]);
    }
    removeShape(shape) {
        this.#call('shape_remove', (m) => [this.#one(m, 'hh_shape', shape)]);
    }

    // ---- Bodies
    addBody(definition) {
        return this.#get('body_add', 'hh_body', () => [this.#library.definition('hh_body_def', definition)]);
    }
    removeBody(body) {
        this.#call('body_remove', (m) => [this.#one(m, 'hh_body', body)]);
    }
    findBody(name) {
        return this.#get('body_find', 'hh_body', (m) => [m.takeText(name)]);
    }
    bodies() {
        return this.#list('world_bodies', 'hh_body');
    }
    bodyPose(body) {
        return this.#get('body_pose', 'hh_pose', (m) => [this.#one(m, 'hh_body', body)]);
    }
    bodyPoses(bodies) {
        return this.#poses('world_body_poses', 'hh_body', 'hh_pose', bodies);
    }
    setBodyVelocity(body, velocity_mps, angular_velocity_radps = { x: 0, y: 0, z: 0 }) {
        this.#call('body_set_velocity', (m) => [this.#one(m, 'hh_body', body),
            this.#one(m, 'hh_vec3', velocity_mps), this.#one(m, 'hh_vec3', angular_velocity_radps)]);
    }
    applyImpulse(body, impulse_ns, point) {
        this.#call('body_apply_impulse', (m) => [this.#one(m, 'hh_body', body),
            this.#one(m, 'hh_vec3', impulse_ns), this.#one(m, 'hh_vec3', point)]);
    }
    teleportBody(body, pose) {
        this.#call('body_teleport', (m) => [this.#one(m, 'hh_body', body), this.#one(m, 'hh_pose', fullPose(pose))]);
    }
    moveKinematic(body, pose) {
        this.#call('body_move_kinematic', (m) => [this.#one(m, 'hh_body', body), this.#one(m, 'hh_pose', fullPose(pose))]);
    }

    // ---- Joints
    addJoint(definition) {
        return this.#get('joint_add', 'hh_joint', () => [this.#library.definition('hh_joint_def', definition)]);
    }
    removeJoint(joint) {
        this.#call('joint_remove', (m) => [this.#one(m, 'hh_joint', joint)]);
    }
    jointState(joint) {
        return this.#library.scratch((m) => {
            const out = m.take(24);
            this.#checked('joint_state', [this.#one(m, 'hh_joint', joint), out, out + 8, out + 16]);
            return { coordinate: m.read('f64', out), speed: m.read('f64', out + 8), latched: m.read('bool', out + 16) };
        });
    }

    // ---- Players
    addPlayer(definition = {}) {
        return this.#get('player_add', 'hh_player', () => [this.#library.definition('hh_player_def', definition)]);
    }
    removePlayer(player) {
        this.#call('player_remove', (m) => [this.#one(m, 'hh_player', player)]);
    }
    teleportPlayer(player, origin) {
        this.#call('player_teleport', (m) => [this.#one(m, 'hh_player', player), this.#one(m, 'hh_pose', fullPose(origin))]);
    }
    /** The wrist in the frame of the samples' hands; null: a controller's grip pose (the default). */
    setHandInController(player, side, hand_in_controller) {
        this.#call('player_set_hand_in_controller', (m) => [this.#one(m, 'hh_player', player), side,
            hand_in_controller === null ? 0 : this.#one(m, 'hh_pose', fullPose(hand_in_controller))]);
    }
    playerPoses(players) {
        const sizes = [layoutOf('hh_player_pose').size, layoutOf('hh_hand_state').size];
        return this.#poses('world_player_poses_sized', 'hh_player', 'hh_player_pose', players, sizes);
    }
    playerPose(player) {
        return this.playerPoses([player])[0];
    }
    handJoints(player, side, space) {
        return this.#library.scratch((m) => {
            const out = m.take(HAND_JOINTS * layoutOf('hh_hand_joint').size);
            this.#checked('player_hand_joints', [this.#one(m, 'hh_player', player), side, space, out]);
            return m.readList('hh_hand_joint', out, HAND_JOINTS);
        });
    }
    bodyJoints(player, space) {
        return this.#library.scratch((m) => {
            const out = m.take(BODY_JOINTS * layoutOf('hh_pose').size);
            this.#checked('player_body_joints', [this.#one(m, 'hh_player', player), space, out]);
            return m.readList('hh_pose', out, BODY_JOINTS);
        });
    }
    grip(player, side, body) {
        this.#call('hand_grip', (m) => [this.#one(m, 'hh_player', player), side, this.#one(m, 'hh_body', body)]);
    }
    releaseHand(player, side) {
        this.#call('hand_release', (m) => [this.#one(m, 'hh_player', player), side]);
    }
    addGrip(body, definition) {
        this.#call('body_add_grip', (m) => [this.#one(m, 'hh_body', body), this.#library.definition('hh_grip_def', definition)]);
    }
    /** The hand's proportions from the bytes of a glTF file; null: the built-in hand. */
    setHandRig(player, side, gltf) {
        this.#call('player_set_hand_rig', (m) => [this.#one(m, 'hh_player', player), side,
            gltf === null ? 0 : m.takeBytes(gltf), gltf === null ? 0 : gltf.byteLength]);
    }
    /** The player's body drives the humanoid skeleton of a glTF file, given as bytes; null: none. */
    setBodyRig(player, gltf) {
        this.#call('player_set_body_rig', (m) => [this.#one(m, 'hh_player', player),
            gltf === null ? 0 : m.takeBytes(gltf), gltf === null ? 0 : gltf.byteLength]);
    }
    /** Poses of the body rig's joints, in the file's order. */
    skeleton(player, space) {
        return this.#list('player_skeleton', 'hh_pose', (m) => [this.#one(m, 'hh_player', player), space]);
    }
    /** {name, parent} of a joint of the body rig; parent -1: none. */
    skeletonJoint(player, joint) {
        return this.#library.scratch((m) => {
            const out = m.take(8);
            this.#checked('player_skeleton_joint', [this.#one(m, 'hh_player', player), joint, out, out + 4]);
            return { name: m.read('text', out), parent: m.read('i32', out + 4) };
        });
    }

    // ---- Steps
    /** Steps by dt_s. inputs: [{player, samples: [...], commands: {...}}], at most one a player. */
    step(dt_s, inputs = []) {
        this.#step('world_step', dt_s, inputs);
    }
    /** The same while the game is paused: only heads, hands and bodies of players follow. */
    stepPoseOnly(dt_s, inputs = []) {
        this.#step('world_step_pose_only', dt_s, inputs);
    }
    #step(name, dt_s, inputs) {
        this.#library.scratch((m) => {
            const { size } = layoutOf('hh_player_input');
            const at = m.take(size * inputs.length);
            inputs.forEach((input, i) => this.#writeInput(m, at + i * size, input));
            this.#checked(name, [dt_s, at, inputs.length]);
        });
    }
    #writeInput(m, at, { player, samples = [], commands = {} }) {
        const sampleSize = layoutOf('hh_tracking_sample').size;
        const list = m.take(sampleSize * samples.length);
        samples.forEach((sample, i) => {
            this.#library.fillDefault('hh_tracking_sample', list + i * sampleSize);
            m.write('hh_tracking_sample', list + i * sampleSize, sample);
        });
        this.#library.fillDefault('hh_player_input', at);
        m.write('hh_player_input', at, { player, samples: list, sample_count: samples.length, commands });
    }
    /** {time_s, frame} of the world's clock. */
    time() {
        return this.#library.scratch((m) => {
            const out = m.take(16);
            this.#checked('world_time', [out, out + 8]);
            return { time_s: m.read('f64', out), frame: m.read('u64', out + 8) };
        });
    }
    /** What happened in the last step. */
    events() {
        return this.#library.scratch((m) => {
            const out = m.take(8);
            this.#checked('world_events_sized', [out, out + 4, layoutOf('hh_event').size]);
            return m.readList('hh_event', m.read('pointer', out), m.read('u32', out + 4));
        });
    }
    /** Equal on every machine after equal calls with equal names. */
    hash() {
        return this.#get('world_hash', 'u64');
    }
    stats() {
        return this.#library.scratch((m) => {
            const at = this.#library.definition('hh_world_stats', {});
            this.#checked('world_get_stats', [at]);
            return m.read('hh_world_stats', at);
        });
    }
    save() {
        return this.#library.scratch((m) => {
            const size = m.take(4);
            this.#checked('world_save', [0, 0, size]);
            const count = m.read('u32', size);
            const at = m.take(count);
            this.#checked('world_save', [at, count, size]);
            return this.#library.memory.bytes(at, count).slice();
        });
    }
    restore(bytes) {
        this.#call('world_restore', (m) => [m.takeBytes(bytes), bytes.byteLength]);
    }

    // ---- Tuning and gravity
    setGravity(gravity_mps2) {
        this.#call('world_set_gravity', (m) => [this.#one(m, 'hh_vec3', gravity_mps2)]);
    }
    setTuning(name, ...values) {
        this.#call('world_set_tuning', (m) => [m.takeText(name), m.takeList('f64', values), values.length]);
    }
    getTuning(name, count = 1) {
        return this.#library.scratch((m) => {
            const out = m.take(8 * count);
            this.#checked('world_get_tuning', [m.takeText(name), out, count]);
            return m.readList('f64', out, count);
        });
    }
    loadTuning(json) {
        this.#loadText('world_load_tuning', json);
    }
    /** Additive clips of all players' bodies (docs/reference/body_clips.md); null: none. */
    loadBodyClips(json) {
        this.#loadText('world_load_body_clips', json);
    }
    #loadText(name, text) {
        this.#call(name, (m) => {
            const bytes = new TextEncoder().encode(text ?? '');
            return [text === null ? 0 : m.takeBytes(bytes), bytes.length];
        });
    }
}

const HAND_JOINTS = 26;
const BODY_JOINTS = 20;

// A pose outside a definition has no default to fall back to.
function fullPose({ position = { x: 0, y: 0, z: 0 }, rotation = { x: 0, y: 0, z: 0, w: 1 } }) {
    return { position, rotation };
}
function withPose(part) {
    return { ...part, pose: fullPose(part.pose ?? {}) };
}
