// The JavaScript binding against a library of JavaScript functions whose malloc grows the memory each time: views, callbacks, arrays.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Handhold, HandholdError, HH_ERROR_STATE } from './handhold.js';
import { layoutOf } from './memory.js';

const field = (kind, name) => layoutOf(kind).fields.find((one) => one.name === name).offset;

function makeLibrary(functions) {
    const memory = new WebAssembly.Memory({ initial: 1 });
    const table = new WebAssembly.Table({ initial: 1, element: 'anyfunc' });
    const view = () => new DataView(memory.buffer);
    const word = (at) => view().getUint32(at, true);
    const known = {
        memory,
        __indirect_function_table: table,
        malloc(size) {
            const at = memory.buffer.byteLength;
            memory.grow(Math.ceil(size / 65536) + 1);
            return at;
        },
        hh_world_create: (definition, out) => (view().setUint32(out, 1, true), 0),
        ...functions({ memory, table, view, word }),
    };
    const exports = new Proxy(known, {
        get: (all, name) => all[name] ?? (/^hh_default_/.test(name) ? (at, size) => (view().setUint32(at, size, true), 0) : () => 0),
    });
    return new Handhold(exports);
}

test('a memory that grows inside of a call detaches no view, and large meshes cost little', () => {
    let mesh;
    const handhold = makeLibrary(({ memory, word }) => ({
        hh_mesh_create(at) {
            const list = (Kind, name, length) => new Kind(memory.buffer, word(at + field('hh_mesh_def', name)), length).slice();
            const vertices = word(at + field('hh_mesh_def', 'vertex_count'));
            const corners = word(at + field('hh_mesh_def', 'index_count'));
            mesh = { vertices, positions: list(Float32Array, 'positions', 3 * vertices), indices: list(Uint32Array, 'indices', corners) };
            return 0;
        },
    }));
    const positions = new Float32Array(3e6).map((_, i) => i);
    const indices = [0, 1, 2];
    handhold.createMesh({ positions, indices });
    assert.equal(mesh.vertices, 1e6);
    assert.deepEqual(mesh.positions, positions);
    assert.deepEqual([...mesh.indices], indices);
    assert.throws(() => handhold.createMesh({ positions: [0, 1], indices }), TypeError);
});

test('texts and lists of structs survive growth too', () => {
    const names = [];
    const handhold = makeLibrary(({ word }) => ({
        hh_body_add(world, at) {
            names.push(handhold.memory.text(word(at + field('hh_body_def', 'name'))));
            return 0;
        },
        hh_world_step(world, dt, inputs, count) {
            const samples = word(inputs + field('hh_player_input', 'samples'));
            names.push(count, handhold.memory.read('hh_tracking_sample', samples + layoutOf('hh_tracking_sample').size).time_s);
            return 0;
        },
    }));
    const world = handhold.createWorld();
    world.addBody({ name: 'x'.repeat(100000) });
    const samples = Array.from({ length: 1000 }, (_, i) => ({ time_s: i }));
    world.step(1 / 90, [{ samples }]);
    assert.deepEqual(names, ['x'.repeat(100000), 1, 1]);
});

test('fingers need all joints of a hand', () => {
    const handhold = makeLibrary(({ view }) => ({
        hh_finger_curls_of(joints, curls) {
            view().setFloat64(curls, view().getFloat64(joints + 25 * layoutOf('hh_hand_joint').size, true), true);
            return 0;
        },
    }));
    const joints = Array.from({ length: 26 }, (_, i) => ({ pose: { position: { x: i, y: 0, z: 0 } } }));
    assert.equal(handhold.fingerCurlsOf(joints).fingers[0], 25);
    for (const wrong of [undefined, null, joints[0], joints.slice(1)]) {
        assert.throws(() => handhold.fingerCurlsOf(wrong), TypeError);
    }
});

test('a world is not destroyed inside its own query', () => {
    let destroyed = 0;
    let query = 0;
    const handhold = makeLibrary(({ table, word }) => ({
        hh_world_destroy: () => { ++destroyed; },
        hh_world_set_surface_query(world, at) {
            query = at === 0 ? 0 : word(at + field('hh_surface_query', 'closest_point'));
            return 0;
        },
        hh_world_step() {
            table.get(query)(0, 1024, 1.0, 0, 0, 2048);
            table.get(query)(0, 1024, 1.0, 0, 0, 2048);
            return 0;
        },
    }));
    const world = handhold.createWorld();
    world.setSurfaceQuery({ closest_point: () => world.destroy() });
    assert.throws(() => world.step(1 / 90), (error) => error instanceof HandholdError && error.result === HH_ERROR_STATE);
    assert.equal(destroyed, 0);
    world.setSurfaceQuery({ closest_point: () => true });
    assert.throws(() => world.step(1 / 90), TypeError);
    world.setSurfaceQuery();
    assert.equal(query, 0);
    world.destroy();
    assert.equal(destroyed, 1);
});

test('meshes are converted in place only if both lists are there', () => {
    const handhold = makeLibrary(() => ({}));
    assert.deepEqual(handhold.convertMeshFrom(0, [1, 2, 3], null), { coordinates: [1, 2, 3], indices: [] });
});

test('structs by value are needed, and null is no id', () => {
    const asked = [];
    const handhold = makeLibrary(({ word }) => ({
        hh_body_remove: (world, body) => (asked.push(word(body), word(body + 4)), 0),
        hh_body_add: (world, at) => (asked.push(word(at + field('hh_body_def', 'shape'))), 0),
    }));
    const world = handhold.createWorld();
    world.removeBody({ index: 3, generation: 4 });
    world.removeBody(null);
    world.addBody({ shape: null });
    assert.deepEqual(asked, [3, 4, 0, 0, 0]);
    assert.throws(() => world.removeBody(), { name: 'TypeError', message: 'body: a hh_body is needed' });
    assert.throws(() => world.addBox(), TypeError);
    assert.throws(() => world.addBox(null), TypeError);
    assert.throws(() => world.addBox({ x: 1, y: 1 }), TypeError);
    world.setBodyVelocity(null, { x: 0, y: 0, z: 0 });
    world.addPlayer();
    assert.equal(asked.length, 5);
});

test('numbers are numbers in lists too, and whole where the library needs it', () => {
    const handhold = makeLibrary(() => ({}));
    const world = handhold.createWorld();
    const positions = [0, 0, 0];
    for (const wrong of [{ positions: ['0', 0, 0] }, { positions: [0, , 0] }, { positions, indices: ['0'] }, { positions, indices: [0.5] },
        { positions, indices: new Float32Array([0.5]) }, { positions, fits_hands: 'no' }, { positions, fits_hands: null }]) {
        assert.throws(() => handhold.createMesh(wrong), TypeError, JSON.stringify(wrong));
    }
    handhold.createMesh({ positions: new Float64Array(positions), indices: new Uint16Array([0]), fits_hands: false });
    handhold.createMesh({ positions, indices: new Float32Array([0, 1, 2]), fits_hands: 1 });
    assert.throws(() => world.addBody({ kind: 0.5 }), TypeError);
    assert.throws(() => world.addBody({ kind: '1' }), TypeError);
    assert.throws(() => world.bodySetKind(null, 1.5), TypeError);
    assert.throws(() => world.bodySetUserData(null, '5'), TypeError);
    world.bodySetUserData(null, 5);
    world.bodySetUserData(null, 5n);
});
