// What the page reads from WebXR's devices: the table that the native game's test plays too, and what only browsers have.
// `node --test game/web/test/devices.test.mjs`: needs neither a browser nor packages.
import assert from 'node:assert/strict';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

// devices.js beside stand-ins for the packages that it imports: the headset uses only the sides' numbers.
const here = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'handhold-devices-'));
after(() => rmSync(folder, { recursive: true }));
cpSync(join(here, '../demo/devices.js'), join(folder, 'devices.mjs'));
for (const [name, text] of [['three', ''], ['handhold', 'export const HH_LEFT = 0, HH_RIGHT = 1;']]) {
    mkdirSync(join(folder, 'node_modules', name), { recursive: true });
    writeFileSync(join(folder, 'node_modules', name, 'package.json'), '{"type":"module","main":"index.js"}');
    writeFileSync(join(folder, 'node_modules', name, 'index.js'), text);
}
const { Headset } = await import(pathToFileURL(join(folder, 'devices.mjs')));

const at = (x, y, z, emulatedPosition = false) => ({ emulatedPosition, transform: { position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 } } });
const sides = ['left', 'right'];
const wristOf = (side) => [side === 'left' ? -0.2 : 0.2, 1.3, -0.4];

// Joints of a hand at `wrist`, each finger with the given curl (0 straight, 1 folded; null: not seen).
function fingers(side, curls, seen) {
    const [x, y, z] = wristOf(side);
    const joints = seen ? { wrist: at(x, y, z) } : {};
    ['middle', 'ring', 'pinky'].forEach((finger, i) => {
        const curl = curls[i];
        if (seen && curl !== null) {
            const [cos, sin] = [1 - 2 * curl, Math.sqrt(1 - (1 - 2 * curl) ** 2)];
            joints[`${finger}-finger-phalanx-proximal`] = at(x, y, z - 0.09);
            joints[`${finger}-finger-tip`] = at(x, y - 0.09 * sin, z - 0.09 - 0.09 * cos);
        }
    });
    return { handedness: side, targetRayMode: 'tracked-pointer', hand: { get: (name) => ({ pose: joints[name] ?? null }) }, gripSpace: { pose: joints.wrist ?? null } };
}
function controller(side, { seen = true, guess = false, squeeze = 0, trigger = 0, stick, touchpad, brake = false, calibrate = false }) {
    const button = (value) => ({ value, pressed: value > 0 });
    const buttons = [button(trigger), button(squeeze), button(0), button(0), button(Number(brake)), button(Number(calibrate))];
    if (touchpad !== undefined) { // as the Vive's
        buttons.splice(2, 4, button(Number(brake)));
    }
    const [x, y] = touchpad ?? stick ?? [0, 0];
    return { handedness: side, targetRayMode: 'tracked-pointer', gripSpace: { pose: seen ? at(...wristOf(side), guess) : null },
        gamepad: { mapping: 'xr-standard', buttons, axes: touchpad !== undefined ? [x, -y] : [0, 0, x, -y] } };
}
function sourcesOf(side, given) {
    if (given === undefined) {
        return [];
    }
    const both = given.controller && given.fingers !== undefined;
    return [...(given.fingers !== undefined ? [fingers(side, given.fingers, both || (given.seen ?? true))] : []), ...(given.controller ? [controller(side, given)] : [])];
}
function frameOf(session, inputSources, focus = true) {
    Object.assign(session, { inputSources, visibilityState: focus ? 'visible' : 'visible-blurred' });
    return { session, getViewerPose: () => at(0, 1.6, 0), getPose: (space) => space.pose, getJointPose: (joint) => joint?.pose ?? null };
}
function newSession() {
    const listeners = {};
    return { addEventListener: (name, listener) => { (listeners[name] ??= []).push(listener); }, tell: (name, event) => (listeners[name] ?? []).forEach((listener) => listener(event)) };
}

for (const { name, steps } of JSON.parse(readFileSync(join(here, '../../../tests/game/devices/headset_cases.json'), 'utf8'))) {
    test(`as the native game: ${name}`, () => {
        const headset = new Headset();
        const session = newSession();
        steps.forEach((step, i) => {
            const { usesWrists, sample, commands } = headset.read(frameOf(session, sides.flatMap((side) => sourcesOf(side, step[side])), step.focus), {}, false);
            sides.forEach((side, index) => {
                const { tracked, inferred, grab, wrist, squeeze, trigger } = step.expect[side] ?? {};
                const told = { tracked: sample.hand_tracked[index], inferred: sample.hand_inferred[index], grab: sample.grab[index], wrist: usesWrists[index], squeeze: sample.squeeze[index], trigger: sample.trigger[index] };
                for (const [key, wanted] of Object.entries({ tracked, inferred, grab, wrist, squeeze, trigger })) {
                    assert.ok(wanted === undefined || told[key] === wanted, `step ${i}, ${side} ${key}: ${told[key]}`);
                }
            });
            const { snap_turns, brake, calibrate, thrust } = step.expect;
            assert.ok(snap_turns === undefined || (commands.snap_turns ?? 0) === snap_turns, `step ${i}: ${commands.snap_turns} snap turns`);
            assert.ok(brake === undefined || (commands.brake ?? 0) === brake, `step ${i}: brake ${commands.brake}`);
            assert.ok(calibrate === undefined || (commands.calibrate ?? false) === calibrate, `step ${i}: calibrate`);
            if (thrust !== undefined) {
                assert.ok(Math.hypot(commands.thrust.x - thrust[0], commands.thrust.y - thrust[1], commands.thrust.z - thrust[2]) < 1e-9, `step ${i}: ${JSON.stringify(commands.thrust)}`);
            }
        });
    });
}

const read = (headset, session, sources, focus) => headset.read(frameOf(session, sources, focus), {}, false).sample;
const pinch = (side, z) => ({ handedness: side, targetRayMode: 'transient-pointer', gripSpace: { pose: at(0.2, 1.33, z) } });

test('a source that stands for a pinch never hides tracked fingers, in any order', () => {
    for (const order of [1, -1]) {
        const sample = read(new Headset(), newSession(), [fingers('right', [0.1, 0.1, 0.1], true), pinch('right', -0.55)].toSorted(() => order));
        assert.deepEqual([sample.grab[1], sample.hands[1].position.z], [false, -0.4]);
    }
});

test('without tracked fingers a pinch is the hand, closed as long as its source lives', () => {
    const [headset, session] = [new Headset(), newSession()];
    assert.equal(read(headset, session, []).grab[1], false);
    assert.deepEqual([read(headset, session, [pinch('right', -0.55)]).grab[1], read(headset, session, [pinch('right', -0.5)]).hand_tracked[1]], [true, true]);
    assert.equal(read(headset, session, []).grab[1], false);
});

test('a controller without a gamepad closes by the session\'s events', () => {
    const [headset, session] = [new Headset(), newSession()];
    for (const [down, up] of [['selectstart', 'selectend'], ['squeezestart', 'squeezeend']]) {
        const source = { handedness: 'left', targetRayMode: 'tracked-pointer', gripSpace: { pose: at(-0.2, 1.3, -0.4) } };
        assert.equal(read(headset, session, [source]).grab[0], false);
        session.tell(down, { inputSource: source });
        assert.equal(read(headset, session, [source]).grab[0], true);
        session.tell(up, { inputSource: source });
        assert.equal(read(headset, session, [source]).grab[0], false);
    }
});

test('a pose that the runtime infers is not tracked: it keeps the button and moves nothing', () => {
    const [headset, session] = [new Headset(), newSession()];
    const held = controller('right', { squeeze: 1 });
    assert.equal(read(headset, session, [held]).grab[1], true);
    const inferred = { ...controller('right', { squeeze: 0 }), gripSpace: { pose: at(0.5, 1, -0.2, true) } };
    const sample = read(headset, session, [inferred]);
    assert.deepEqual([sample.grab[1], sample.hand_tracked[1], sample.hand_inferred[1]], [true, false, true]);
    assert.equal(sample.hands[1].position.x, 0.5); // shown there
    assert.equal(read(headset, session, [held]).hand_inferred[1], false);
});

// A hand whose fingers bend by these angles at each of their joints, radians; null: joints without a pose.
function bent(side, bends) {
    const joints = { wrist: at(...wristOf(side)) };
    const chains = { thumb: ['thumb-metacarpal', 'thumb-phalanx-proximal', 'thumb-phalanx-distal', 'thumb-tip'] };
    for (const name of ['index', 'middle', 'ring', 'pinky']) {
        chains[name] = ['metacarpal', 'phalanx-proximal', 'phalanx-intermediate', 'phalanx-distal', 'tip'].map((joint) => `${name}-finger-${joint}`);
    }
    Object.values(chains).forEach((chain, finger) => {
        let [y, z, angle] = [0, 0, 0];
        chain.forEach((name, i) => {
            joints[name] = bends[finger] === null && i > 1 ? undefined : at(0.02 * finger, 1.3 + y, -0.4 + z);
            angle += i === 0 ? 0 : bends[finger] ?? 0;
            y -= 0.03 * Math.sin(angle);
            z -= 0.03 * Math.cos(angle);
        });
    });
    return { handedness: side, targetRayMode: 'tracked-pointer', hand: { get: (name) => ({ pose: joints[name] ?? null }) } };
}
test('each finger has its own curl, and keeps it while it is not seen', () => {
    const [headset, session] = [new Headset(), newSession()];
    const curls = (bends) => read(headset, session, [bent('right', bends)]).curls[1].fingers;
    assert.deepEqual(curls([0, 0, 0, 0, 0]).map((curl) => Math.abs(curl) < 1e-9), Array(5).fill(true));
    const pointing = curls([0.4, 0, 1.4, 1.4, 1.4]);
    const fist = { thumb: (50 + 65) * Math.PI / 180, finger: (110 + 105 + 75) * Math.PI / 180 }; // systems/rigs/hand_limits.cpp
    const expected = [2 * 0.4 / fist.thumb, 0, ...Array(3).fill(3 * 1.4 / fist.finger)];
    assert.ok(pointing.every((curl, finger) => Math.abs(curl - expected[finger]) < 1e-9), `${pointing}`);
    assert.deepEqual(curls([0.4, null, null, null, null]), pointing);
    assert.deepEqual(read(headset, session, [controller('right', {})]).curls[1].fingers, Array(5).fill(-1));
});

test('the next session begins with open hands', () => {
    const [headset, first, second] = [new Headset(), newSession(), newSession()];
    assert.equal(read(headset, first, [fingers('right', [0.9, 0.9, 0.9], true)]).grab[1], true);
    first.tell('end', {});
    assert.equal(read(headset, second, [fingers('right', [null, null, null], true)]).grab[1], false);
});

test('sources of no side and of nothing that is held are ignored', () => {
    const sample = read(new Headset(), newSession(), [{ handedness: 'none', targetRayMode: 'gaze' }, { handedness: 'left', targetRayMode: 'screen' }]);
    assert.deepEqual([sample.hand_tracked, sample.grab], [[false, false], [false, false]]);
});
