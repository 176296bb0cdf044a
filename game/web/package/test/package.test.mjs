// The package in Node: `node --test` with HANDHOLD_PACKAGE set to its folder.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { playSameScene } from './same_scene.mjs';
import { playWall } from './wall_scene.mjs';

const folder = pathToFileURL(resolve(process.env.HANDHOLD_PACKAGE) + '/');
const handholdModule = await import(new URL('handhold.js', folder));
const { loadHandhold, HandholdError, structs, HH_DYNAMIC, HH_ERROR_DATA, HH_ERROR_HANDLE, HH_ERROR_STATE, HH_ERROR_VALUE, HH_GRIP_HELD, HH_GRIP_SURFACE, HH_HEAD,
    HH_HINGE, HH_LEFT, HH_LEFT_FOOT, HH_MATCH_CLIENT, HH_MATCH_SERVER, HH_MATCH_SYNC_TEST, HH_RIGHT, HH_SPACE_WORLD } = handholdModule;
const { layoutOf } = await import(new URL('memory.js', folder));
const { calls } = await import(new URL('calls.js', folder));
const handhold = await loadHandhold();

const rotation = { x: Math.SQRT1_2, y: 0, z: 0, w: Math.SQRT1_2 };
function sampleAt(time_s, pull_m = 0.2) {
    const z = -0.43 + pull_m * Math.min(Math.max(2 * (time_s - 1), 0), 1);
    return {
        time_s,
        head: { position: { x: 0, y: 1.6, z: 0 } },
        hands: [{ position: { x: -0.2, y: 1.4, z: -0.43 }, rotation }, { position: { x: 0.2, y: 1.4, z }, rotation }],
        grab: [false, time_s >= 0.5],
    };
}
// A wall before a player whose hands are tracked as wrists.
function makeWall() {
    const world = handhold.createWorld();
    const shape = world.addBox({ x: 2, y: 2, z: 0.1 });
    const wall = world.addBody({ name: 'wall', shape, pose: { position: { x: 0, y: 1.5, z: -0.6 } } });
    const player = world.addPlayer({ name: 'you' });
    world.setHandInController(player, HH_LEFT, {});
    world.setHandInController(player, HH_RIGHT, {});
    return { world, wall, player };
}
function play({ world, player }, first, last, pull_m) {
    for (let frame = first; frame <= last; ++frame) {
        world.step(1 / 90, [{ player, samples: [sampleAt(frame / 90, pull_m)] }]);
    }
}

test('every struct has the size that the library expects', () => {
    // The library refuses a definition, and does not fill in defaults, of another size than its own.
    for (const kind of Object.keys(structs).filter((one) => structs[one][0][0] === 'struct_size')) {
        handhold.scratch((m) => {
            const at = m.take(layoutOf(kind).size + 64);
            m.bytes(at, layoutOf(kind).size + 64).fill(0xa5);
            m.fill(kind, at);
            assert.equal(m.view.getUint32(at, true), layoutOf(kind).size, kind);
        });
    }
});

test('the smaller module lacks files, saves and matches, says so, and steps alike', async () => {
    const core = await loadHandhold(new URL('handhold-core.wasm', folder));
    assert.equal(playSameScene(core, handholdModule).hash, playSameScene(handhold, handholdModule).hash);
    const missing = Object.keys(handhold.exports).filter((name) => name.startsWith('hh_') && core.exports[name] === undefined);
    assert.ok(missing.every((name) => /match_|_rig$|gltf_level|load_(body_clips|tuning)|world_(save|restore)/.test(name)), missing.join(' '));
    const world = core.createWorld();
    assert.throws(() => world.loadTuning('{}'), (error) => error instanceof HandholdError && /hh_world_load_tuning is in handhold.wasm/.test(error.message));
    world.destroy();
});

test('every function of the library is a method', () => {
    const byHand = /^hh_(default_\w+_sized|(world|mesh|match)_(create|destroy)|last_error)$/;
    const types = { '': handholdModule.Handhold, hh_world: handholdModule.World, hh_match: handholdModule.Match };
    const exported = Object.keys(handhold.exports).filter((name) => name.startsWith('hh_'));
    assert.ok(exported.length >= 130);
    for (const name of exported.filter((one) => !byHand.test(one))) {
        const { method, of } = calls[name];
        assert.equal(typeof types[of].prototype[method], 'function', name);
    }
    assert.equal(new Set(Object.values(calls).map((call) => `${call.of}.${call.method}`)).size, Object.keys(calls).length);
});

// A server and a client of one match, with a score that goes back and forth with the worlds.
function makeMatch() {
    const game = () => {
        const copies = [];
        const kept = { score: 0 };
        return [kept, {
            step: (tick, buttons) => { kept.score += buttons[0]; },
            save: (place) => { copies[place] = kept.score; },
            restore: (place) => { kept.score = copies[place]; },
            hash: () => BigInt(kept.score),
        }];
    };
    const [atServer, atClient] = [makeWall(), makeWall()];
    const [[serverGame, ofServer], [clientGame, ofClient]] = [game(), game()];
    const server = atServer.world.createMatch({ role: HH_MATCH_SERVER, players: [atServer.player] }, ofServer);
    const client = atClient.world.createMatch({ role: HH_MATCH_CLIENT, players: [atClient.player] }, ofClient);
    server.connect(0);
    return { atServer, atClient, server, client, serverGame, clientGame };
}

test('a client and a server play a match over packets, with equal hashes', () => {
    const { atServer, atClient, server, client, serverGame, clientGame } = makeMatch();
    const arriving = [];
    for (let tick = 1; tick <= 180; ++tick) {
        const now_s = tick / 90;
        assert.equal(client.advance({ samples: [sampleAt(now_s)], buttons: tick % 3 }), true);
        arriving.push(client.packet());
        if (tick > 4) { // four ticks on the way
            const packet = arriving.shift();
            assert.ok(packet.length > 0 && packet.length < 1200);
            server.receiveFrom(0, now_s, packet);
        }
        while (server.confirm(now_s - 0.1) > 0);
        client.receive(server.packetTo(0));
    }
    const { confirmed } = client.getStats();
    assert.ok(confirmed > 150n, String(confirmed));
    assert.equal(server.getStats().tick, confirmed);
    assert.equal(client.hash(confirmed), server.hash(confirmed));
    assert.equal(atServer.world.playerPose(atServer.player).hands[HH_RIGHT].grip, HH_GRIP_SURFACE);
    assert.ok(serverGame.score > 100 && clientGame.score >= serverGame.score);
    const { buffer, until } = server.confirmedInputs(confirmed - 10n);
    assert.ok(buffer.length > 0 && until === confirmed);
    assert.throws(() => client.receive(new Uint8Array(40)), (error) => error.result === HH_ERROR_DATA);
    for (const match of [server, client]) {
        match.destroy();
    }
    atServer.world.destroy();
    atClient.world.destroy();
});

test('what a game forgets to restore is found by a sync test', () => {
    for (const forgets of [false, true]) {
        const { world, player } = makeWall();
        const copies = [];
        let steps = 0;
        const match = world.createMatch({ role: HH_MATCH_SYNC_TEST, players: [player] }, {
            step: () => { ++steps; }, save: (place) => { copies[place] = steps; },
            restore: (place) => { steps = forgets ? steps : copies[place]; }, hash: () => BigInt(steps),
        });
        let found = 0n;
        for (let tick = 1; tick <= 20 && found === 0n; ++tick) {
            found = match.syncTest([{ samples: [sampleAt(tick / 90)] }]).tick;
        }
        assert.equal(found > 0n, forgets);
        match.destroy();
        world.destroy();
    }
});

test('a world in a match is not destroyed, and keeps its functions', () => {
    const { world, player } = makeWall();
    let asked = 0;
    world.setSurfaceQuery({ closest_point() { ++asked; return null; } });
    const syncTest = { role: HH_MATCH_SYNC_TEST, players: [player] };
    const match = world.createMatch(syncTest);
    assert.throws(() => world.createMatch(syncTest), (error) => error.result === HH_ERROR_STATE);
    const isRefused = (error) => error instanceof HandholdError && error.result === HH_ERROR_STATE && /in a match/.test(error.message);
    assert.throws(() => world.destroy(), isRefused);
    for (let tick = 1; tick <= 60; ++tick) {
        assert.equal(match.syncTest([{ samples: [sampleAt(tick / 90)] }]).tick, 0n);
    }
    assert.ok(asked > 0);
    match.destroy();
    match.destroy(); // counts once
    const next = world.createMatch(syncTest);
    assert.throws(() => world.destroy(), isRefused);
    next.destroy();
    world.destroy();
});

test('a second destroy() frees nothing of others', () => {
    const [first, second] = [makeWall(), makeWall()];
    let asked = 0;
    const query = { closest_point() { ++asked; return null; } };
    first.world.setSurfaceQuery(query);
    first.world.destroy();
    second.world.setSurfaceQuery(query); // in the places that are free now
    first.world.destroy();
    const other = makeWall();
    other.world.setSurfaceQuery({ closest_point() { throw new RangeError('of another world'); } });
    play(second, 1, 60);
    assert.ok(asked > 0);
    other.world.destroy();
    second.world.destroy();
});

test("a host's own physics gets the hash of a native program that makes the same calls", (context) => {
    const { line, calls: queries } = playWall(handhold, handholdModule);
    context.diagnostic(`${line}, ${queries} queries`);
    assert.match(line, /^0x[0-9a-f]{16} grabs 1 moved_mm 200\.000$/);
    if (process.env.HANDHOLD_NATIVE_WALL !== undefined) {
        assert.equal(line, execFileSync(process.env.HANDHOLD_NATIVE_WALL, { encoding: 'utf8' }).trim());
    }
});

test('what a query throws reaches the caller, and places in the table are used again', () => {
    const world = handhold.createWorld();
    const table = handhold.exports.__indirect_function_table;
    const player = world.addPlayer();
    const wall = world.addBody({ pose: { position: { x: 0, y: 1.5, z: -0.6 } } });
    const broken = { closest_point() { throw new RangeError('no level'); } };
    world.setSurfaceQuery(broken);
    const length = table.length;
    for (let i = 0; i < 10; ++i) {
        world.setSurfaceQuery(broken);
    }
    assert.ok(table.length <= length + 1);
    assert.throws(() => play({ world, wall, player }, 1, 60), RangeError);
    world.setSurfaceQuery(null);
    play({ world, wall, player }, 61, 70);
    world.destroy();
});

test('a hand on a wall moves the player as much as it moves towards the body', () => {
    const scene = makeWall();
    play(scene, 1, 180, 0.15);
    const { origin, hands } = scene.world.playerPose(scene.player);
    assert.equal(hands[HH_RIGHT].grip, HH_GRIP_SURFACE);
    assert.deepEqual(hands[HH_RIGHT].body, scene.wall);
    assert.ok(hands[HH_RIGHT].error_m < 1e-6);
    assert.ok(Math.abs(origin.position.z + 0.15) < 1e-6, `${origin.position.z}`);
    scene.world.destroy();
});

test('the twenty lines of the README do what they say', async () => {
    const text = readFileSync(new URL('../README.md', import.meta.url), 'utf8');
    const code = text.match(/```js\n([\s\S]*?)```/)[1];
    assert.ok(code.trim().split('\n').length <= 24);
    const AsyncFunction = (async () => {}).constructor;
    const said = [];
    const body = code.replace(/import \{(.*?)\} from 'handhold';/, 'const {$1} = handholdModule;');
    await new AsyncFunction('handholdModule', 'console', body)(handholdModule, { log: (...words) => said.push(...words) });
    assert.ok(said[0] < 1e-6);
    assert.ok(Math.abs(said[1] + 0.2) < 1e-6);
});

test('a world goes on from a snapshot bit for bit', () => {
    const scene = makeWall();
    play(scene, 1, 90);
    const saved = scene.world.save();
    play(scene, 91, 200);
    const hash = scene.world.hash();
    scene.world.restore(saved);
    assert.notEqual(scene.world.hash(), hash);
    play(scene, 91, 200);
    assert.equal(scene.world.hash(), hash);
    assert.equal(scene.world.time().frame, 200n);
    assert.throws(() => scene.world.restore(saved.slice(0, 100)), HandholdError);
    scene.world.destroy();
});

test('what the library refuses is thrown, with its result and text', () => {
    const { world, player } = makeWall();
    const before = world.hash();
    assert.throws(() => world.addSphere(-1), (error) => error.result === HH_ERROR_VALUE && error.message.length > 20);
    assert.throws(() => world.addBody({ mass_kg: NaN, kind: HH_DYNAMIC }), HandholdError);
    assert.throws(() => world.bodyPose({ index: 77, generation: 9 }), (error) => error.result === HH_ERROR_HANDLE);
    assert.throws(() => world.addBody({ weight: 3 }), TypeError);
    assert.throws(() => world.step(NaN, [{ player }]), HandholdError);
    assert.equal(world.hash(), before);
    world.destroy();
});

test('arguments of another type are refused before the library sees them', () => {
    const { world, player } = makeWall();
    const before = world.hash();
    const [sample] = [sampleAt(1)];
    const wrong = {
        'a side in words': () => world.handJoints(player, 'right', HH_SPACE_WORLD),
        'a kind in words': () => world.addBody({ kind: 'dynamic' }),
        'a number as a shape': () => world.addBody({ shape: 3 }),
        'an input that is no list': () => world.step(1 / 90, { player }),
        'samples that are no list': () => world.step(1 / 90, [{ player, samples: sample }]),
        'three hands': () => world.step(1 / 90, [{ player, samples: [{ ...sample, hands: [...sample.hands, sample.hands[0]] }] }]),
        'one hand': () => world.step(1 / 90, [{ player, samples: [{ ...sample, hands: [sample.hands[0]] }] }]),
        'hands by name': () => world.step(1 / 90, [{ player, samples: [{ ...sample, hands: { left: {}, right: {} } }] }]),
        'a vector as a list': () => world.addBox([1, 1, 1]),
        'a snapshot of numbers': () => world.restore([1, 2, 3]),
    };
    for (const [name, call] of Object.entries(wrong)) {
        assert.throws(call, TypeError, name);
    }
    assert.equal(world.hash(), before);
    world.destroy();
});

test('a mesh is freed once, and no other number is a mesh', () => {
    const { world } = makeWall();
    const triangle = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], indices: [0, 1, 2] };
    const mesh = handhold.createMesh(triangle);
    handhold.destroyMesh(mesh);
    handhold.destroyMesh(mesh);
    const others = Array.from({ length: 20 }, () => handhold.createMesh(triangle));
    for (const dead of [mesh, 12345].filter((one) => !others.includes(one))) {
        assert.throws(() => world.addMeshShape(dead, { x: 1, y: 1, z: 1 }), (error) => error.result === HH_ERROR_HANDLE);
    }
    others.forEach((one) => assert.ok(world.addMeshShape(one, { x: 1, y: 1, z: 1 })));
    others.forEach((one) => handhold.destroyMesh(one));
    world.destroy();
});

test('lists, names and joints come back as they were given', () => {
    const world = handhold.createWorld({ gravity_mps2: { x: 0, y: -9.81, z: 0 } });
    const shape = world.addCapsule(0.1, 0.5);
    const door = world.addBody({ name: 'Tür', kind: HH_DYNAMIC, shape, mass_kg: 3, pose: { position: { x: 1, y: 2, z: 3 } } });
    const others = Array.from({ length: 50 }, (_, i) =>
        world.addBody({ kind: HH_DYNAMIC, shape, pose: { position: { x: 10 * i + 20, y: 0, z: 0 } } }));
    assert.deepEqual(world.findBody('Tür'), door);
    assert.equal(world.bodies().length, 51);
    assert.equal(world.bodyPoses(others)[49].position.x, 510);
    const hinge = world.addJoint({ kind: HH_HINGE, body_b: door, frame: { position: { x: 1, y: 2.6, z: 3 } } });
    for (let i = 0; i < 45; ++i) {
        world.step(1 / 90);
    }
    assert.ok(Math.abs(world.jointState(hinge).speed) < 100);
    const fallen = world.bodyPose(others[0]).position.y;
    assert.ok(Math.abs(fallen + 0.5 * 9.81 * 0.25) < 0.06, `${fallen}`);
    world.setTuning('hand.reach_m', 0.2);
    assert.deepEqual(world.getTuning('hand.reach_m'), [0.2]);
    world.destroy();
});

test('joints of hands and bodies are those of the shown player', () => {
    const scene = makeWall();
    play(scene, 1, 100);
    const joints = scene.world.handJoints(scene.player, HH_RIGHT, HH_SPACE_WORLD);
    const { hands, head } = scene.world.playerPose(scene.player);
    assert.equal(joints.length, 26);
    assert.deepEqual(joints[1].pose.position, hands[HH_RIGHT].shown.position);
    const body = scene.world.bodyJoints(scene.player, HH_SPACE_WORLD);
    const above = body[HH_HEAD].position.y - head.position.y;
    assert.ok(Math.abs(above) < 0.2, `${above}`);
    scene.world.destroy();
});

test('body clips move legs, and texts that are none are refused', () => {
    const scene = makeWall();
    const idle = JSON.stringify({ idle: { keys: [{ at: 0 }, { at: 1, left_thigh: [30, 0, 0] }, { at: 2 }] } });
    const foot = () => scene.world.bodyJoints(scene.player, HH_SPACE_WORLD)[HH_LEFT_FOOT].position.z;
    scene.world.loadBodyClips(idle);
    play(scene, 1, 90);
    const swung = foot();
    assert.throws(() => scene.world.loadBodyClips('{"idle": 1}'), HandholdError);
    scene.world.loadBodyClips(null);
    play(scene, 91, 135);  // feet have a greatest speed
    assert.ok(Math.abs(foot() - swung) > 0.1, `${foot()}, before ${swung}`);
    scene.world.destroy();
});

test('meshes collide', () => {
    const mesh = handhold.createMesh({ positions: [-1, 0, -1, 1, 0, -1, 0, 0, 1], indices: [0, 2, 1], fits_hands: false });
    const world = handhold.createWorld({ fits_hands: false, gravity_mps2: { x: 0, y: -10, z: 0 } });
    world.addBody({ shape: world.addMeshShape(mesh) });
    handhold.destroyMesh(mesh);
    const ball = world.addBody({ kind: HH_DYNAMIC, shape: world.addSphere(0.1), pose: { position: { x: 0, y: 0.5, z: 0 } } });
    for (let i = 0; i < 180; ++i) {
        world.step(1 / 90);
    }
    assert.ok(Math.abs(world.bodyPose(ball).position.y - 0.1) < 0.01);
    world.destroy();
});

test('the hash equals that of a native program that makes the same calls', (context) => {
    const { hash, grips, step_us } = playSameScene(handhold, handholdModule);
    assert.deepEqual(grips, [HH_GRIP_HELD, HH_GRIP_SURFACE]);
    context.diagnostic(`median step ${step_us.toFixed(1)} us`);
    const native = process.env.HANDHOLD_NATIVE_GRIP;
    if (native === undefined) {
        context.skip('HANDHOLD_NATIVE_GRIP, the native program, is not set');
        return;
    }
    const said = execFileSync(native, { encoding: 'utf8' });
    context.diagnostic(`native ${said.trim()}`);
    assert.equal(hash, said.split(' ')[0]);
});

test('memory stays as it is over many worlds and steps', () => {
    const once = () => {
        const scene = makeWall();
        play(scene, 1, 20);
        scene.world.destroy();
    };
    once();
    const before = handhold.exports.memory.buffer.byteLength;
    for (let i = 0; i < 100; ++i) {
        once();
    }
    assert.equal(handhold.exports.memory.buffer.byteLength, before);
});
