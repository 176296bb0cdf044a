// Handhold in JavaScript: the C interface (handhold.h) with plain objects. Field names are those of
// its structs; vectors are {x, y, z}, rotations {x, y, z, w}, so three.js objects can be passed.
import { addCalls } from './invoke.js';
import { Memory } from './memory.js';
import { HH_ERROR_HANDLE, HH_ERROR_STATE } from './structs.js';

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
 * the file beside this one. handhold-core.wasm is smaller, without files, saved states and matches. */
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

/** Functions without a world; all but the first four are those of the C headers without hh_. */
class LibraryCalls {}
addCalls(LibraryCalls, '');

/** The library. */
export class Handhold extends LibraryCalls {
    #meshes = new Set();

    constructor(exports) {
        super();
        this.exports = exports;
        this.memory = new Memory(exports);
        this.library = this;
    }

    version() {
        const { major, minor, patch } = super.version();
        return `${major}.${minor}.${patch}`;
    }
    createWorld(definition = {}) {
        return new World(this, this.#create('hh_world', definition));
    }
    /** A mesh for World.addMeshShape. `positions`: x, y, z of each vertex; `indices`: three a triangle. */
    createMesh(definition) {
        const mesh = this.#create('hh_mesh', definition);
        this.#meshes.add(mesh);
        return mesh;
    }
    /** A second call does nothing. */
    destroyMesh(mesh) {
        this.refuseInCallback('a mesh');
        if (this.#meshes.delete(mesh)) {
            this.exports.hh_mesh_destroy(mesh);
        }
    }
    /** The mesh, or 0 for none. Throws for what createMesh did not return, and for a destroyed mesh. */
    liveMesh(mesh) {
        if (mesh !== 0 && !this.#meshes.has(mesh)) {
            throw new HandholdError(HH_ERROR_HANDLE, 'HH_ERROR_HANDLE: no mesh of createMesh, or a destroyed one');
        }
        return mesh;
    }
    #create(kind, definition) {
        return this.scratch((m) => {
            const out = m.take(4);
            this.check(this.exports[`${kind}_create`](m.takeOne(`${kind}_def`, definition), out));
            return m.view.getUint32(out, true);
        });
    }

    /** Runs work with scratch memory. */
    scratch(work) {
        const mark = this.memory.mark();
        try {
            return work(this.memory);
        } finally {
            this.memory.release(mark);
        }
    }
    refuseMissing(name) {
        if (this.exports[name] === undefined) {
            throw new HandholdError(HH_ERROR_STATE, `HH_ERROR_STATE: ${name} is in handhold.wasm, not in the module that was loaded`);
        }
    }
    refuseInCallback(what) {
        if (this.memory.functions.running > 0) {
            throw new HandholdError(HH_ERROR_STATE, `HH_ERROR_STATE: ${what} cannot be destroyed inside a callback`);
        }
    }
    check(result) {
        if (result !== 0) {
            const name = this.memory.text(this.exports.hh_result_text(result));
            throw new HandholdError(result, `${name}: ${this.memory.text(this.exports.hh_last_error())}`);
        }
    }
}

/** Every function of a world: hh_world_x as x, hh_body_x and the others as bodyX. */
class WorldCalls {}
addCalls(WorldCalls, 'hh_world');

/** A simulation. Ids are what its functions return; call destroy() when it is no longer needed. */
export class World extends WorldCalls {
    #matches = 0;

    constructor(library, handle) {
        super();
        this.library = library;
        this.handle = handle;
    }
    /** Not inside a callback or in a match: HH_ERROR_STATE. A second call does nothing. */
    destroy() {
        if (this.handle === 0) {
            return;
        }
        this.library.refuseInCallback('a world');
        if (this.#matches > 0) {
            throw new HandholdError(HH_ERROR_STATE, 'HH_ERROR_STATE: a world cannot be destroyed while it is in a match');
        }
        this.library.exports.hh_world_destroy(this.handle);
        this.handle = 0;
        this.setFunctions('', []);
    }

    /** Begins a match at the present tick. `game`: functions for state of your own, hh_match_game. */
    createMatch(definition, game = null) {
        this.library.refuseMissing('hh_match_create');
        return this.library.scratch((m) => {
            const out = m.take(4);
            const at = game === null ? 0 : m.takeOne('hh_match_game', game);
            const places = m.functions.takeInstalled();
            try {
                this.library.check(this.library.exports.hh_match_create(this.handle, m.takeOne('hh_match_def', definition), at, out));
            } catch (error) {
                m.functions.remove(places);
                throw error;
            }
            const match = new Match(this.library, m.view.getUint32(out, true), () => { --this.#matches; });
            ++this.#matches;
            match.setFunctions('hh_match_game', places);
            return match;
        });
    }

    addMeshShape(mesh, scale = { x: 1, y: 1, z: 1 }) {
        return this.shapeAddMesh(mesh, scale);
    }
    setBodyVelocity(body, velocity_mps, angular_velocity_radps = { x: 0, y: 0, z: 0 }) {
        this.bodySetVelocity(body, velocity_mps, angular_velocity_radps);
    }
    playerPose(player) {
        return this.playerPoses([player])[0];
    }
    /** Joints of a player's body in a space; without a space: the joints (hinges and so on) at a body. */
    bodyJoints(id, space) {
        return space === undefined ? super.bodyJoints(id) : this.playerBodyJoints(id, space);
    }
    setTuning(name, ...values) {
        super.setTuning(name, values.flat());
    }
    getTuning(name, count = 1) {
        return super.getTuning(name, count);
    }
}

/** Every function of a match: hh_match_x as x. */
class MatchCalls {}
addCalls(MatchCalls, 'hh_match');

/** A match in which a world takes part, on a server, a client or a spectator. Your transport carries its packets. */
export class Match extends MatchCalls {
    #ended;

    constructor(library, handle, ended) {
        super();
        this.library = library;
        this.handle = handle;
        this.#ended = ended;
    }
    /** The world stays. Not inside a callback: HH_ERROR_STATE. Call it before the world's destroy(). A second call does nothing. */
    destroy() {
        if (this.handle === 0) {
            return;
        }
        this.library.refuseInCallback('a match');
        this.library.exports.hh_match_destroy(this.handle);
        this.handle = 0;
        this.setFunctions('', []);
        this.#ended();
    }
}

// Short names of what most programs call.
const shortNames = {
    addBox: 'shapeAddBox', addSphere: 'shapeAddSphere', addCapsule: 'shapeAddCapsule', addCylinder: 'shapeAddCylinder',
    addHull: 'shapeAddHull', addCompound: 'shapeAddCompound', removeShape: 'shapeRemove',
    addBody: 'bodyAdd', removeBody: 'bodyRemove', findBody: 'bodyFind',
    applyImpulse: 'bodyApplyImpulse', teleportBody: 'bodyTeleport', moveKinematic: 'bodyMoveKinematic', addGrip: 'bodyAddGrip',
    addJoint: 'jointAdd', removeJoint: 'jointRemove', addPlayer: 'playerAdd', removePlayer: 'playerRemove',
    teleportPlayer: 'playerTeleport', setHandInController: 'playerSetHandInController', handJoints: 'playerHandJoints',
    grip: 'handGrip', releaseHand: 'handRelease', setHandRig: 'playerSetHandRig', setBodyRig: 'playerSetBodyRig',
    skeleton: 'playerSkeleton', skeletonJoint: 'playerSkeletonJoint', skeletonFingers: 'playerSkeletonFingers', stats: 'getStats',
};
for (const [short, name] of Object.entries(shortNames)) {
    World.prototype[short] = World.prototype[name];
}
