// A stranger's first seconds on the page: they look about, press a hand's button where the mark is green, and pull with the mouse. In Node: the page's
// modules with the page's library and three.js, without drawing. As tests/game/play/first_minute_test.cpp for the desktop game.
// HANDHOLD_PAGE: the folder that tools/web makes.
import assert from 'node:assert/strict';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

const k_strangers = 24;
const k_needed = 20;
const k_seconds = 15;
const k_dt_s = 1 / 90;
const k_nothing = { canReach: false, grips: false, moved_m: 0 };

const here = dirname(fileURLToPath(import.meta.url));
const page = resolve(process.env.HANDHOLD_PAGE);
const folder = mkdtempSync(join(tmpdir(), 'handhold-minute-'));
after(() => rmSync(folder, { recursive: true }));
for (const file of ['devices', 'level']) {
    cpSync(join(here, `../demo/${file}.js`), join(folder, `${file}.mjs`));
}
const modules = { three: { '.': './three.module.js', './addons/*': './addons/*' }, handhold: { '.': './handhold.js' } };
for (const [name, exports] of Object.entries(modules)) {
    cpSync(join(page, name), join(folder, 'node_modules', name), { recursive: true });
    writeFileSync(join(folder, 'node_modules', name, 'package.json'), JSON.stringify({ name, type: 'module', exports }));
}
// What the modules use of a browser.
globalThis.self = globalThis;
globalThis.ProgressEvent ??= class { };
globalThis.addEventListener ??= () => {};
const element = { addEventListener: () => {} };
globalThis.document ??= { pointerLockElement: null };
globalThis.Request = class { constructor(url) { this.url = url; } };
globalThis.fetch = async (request) => new Response(readFileSync(fileURLToPath(request.url ?? request)));

const { loadHandhold, HH_LEFT, HH_RIGHT } = await import(pathToFileURL(join(folder, 'node_modules/handhold/handhold.js')));
const { Desktop, FirstHint } = await import(pathToFileURL(join(folder, 'devices.mjs')));
const { loadLevel, startBeforeSomethingToGrip } = await import(pathToFileURL(join(folder, 'level.mjs')));
const handhold = await loadHandhold();

// Uniform numbers in [0, 1) from a seed: a 32-bit xorshift of Marsaglia's (2003).
function randomFrom(seed) {
    let state = (2654435761 * (seed + 1)) >>> 0;
    return () => {
        state ^= state << 13;
        state ^= state >>> 17;
        state ^= state << 5;
        state >>>= 0;
        return state / 2 ** 32;
    };
}

/** What a stranger does, from a seed: they know the mark, whether the hand holds something, and nothing else. */
class Stranger {
    constructor(seed) {
        this.random = randomFrom(seed);
        Object.assign(this, { pressed_s: 0, green_s: 0, pulls_s: 0, yaw: 0, pitch: 0, side: HH_LEFT, pull: [0, 0] });
    }
    act(desktop, canReach, grips) {
        const between = (low, high) => low + (high - low) * this.random();
        if (this.pressed_s > 0) {
            this.pressed_s = grips ? 1.5 : this.pressed_s - k_dt_s;
            desktop.pressed[this.side] = this.pressed_s > 0;
            if (grips) {
                this.pulls_s -= k_dt_s;
                if (this.pulls_s < 0) {
                    this.pulls_s = 0.7;
                    this.pull = [between(-6, 6), between(-6, 6)];
                }
                desktop.move(...this.pull); // pixels in a frame
            }
            return;
        }
        this.green_s = canReach ? this.green_s + k_dt_s : 0;
        if (this.green_s > 0.3) {
            Object.assign(this, { side: this.random() < 0.5 ? HH_LEFT : HH_RIGHT, pressed_s: 1.5, green_s: 0 });
            return;
        }
        if (this.yaw === 0 && this.pitch === 0) {
            this.yaw = between(-Math.PI, Math.PI);
            this.pitch = between(-1, 1) - desktop.pitch;
        }
        const part = (name) => {
            const now = Math.max(-2 * k_dt_s, Math.min(2 * k_dt_s, this[name]));
            this[name] -= now;
            return now;
        };
        desktop.move(-part('yaw') / 2.5e-3, -part('pitch') / 2.5e-3);
    }
}

function playStranger(world, player, start, seed, farther_m) {
    world.teleportPlayer(player, { ...start, position: { ...start.position, y: start.position.y + farther_m } });
    const desktop = new Desktop(element, world, player);
    const hint = new FirstHint();
    const stranger = new Stranger(seed);
    const place = () => world.playerPose(player).origin.position;
    const away = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    const from = place();
    const begin_s = world.time().time_s;
    let last = from;
    let grips_s = -1;
    let pulled_m = 0;
    let hinted = hint.text;
    let hints = 0;
    while (world.time().time_s < begin_s + k_seconds) {
        const grips = [HH_LEFT, HH_RIGHT].some((side) => world.handMovesPlayer(player, side));
        const { sample, commands } = desktop.read(k_dt_s);
        const end_s = world.time().time_s + k_dt_s;
        world.step(k_dt_s, [{ player, samples: [{ ...sample, time_s: end_s }], commands }]);
        stranger.act(desktop, desktop.aim !== null, grips);
        const at = place();
        hint.advance({ canReach: desktop.aim !== null, grips, moved_m: away(at, last) }, k_dt_s);
        last = at;
        hints += hint.text !== hinted ? 1 : 0;
        hinted = hint.text;
        if (grips) {
            grips_s = grips_s < 0 ? end_s - begin_s : grips_s;
            pulled_m = Math.max(pulled_m, away(at, from));
        }
    }
    hint.advance(k_nothing, 10); // the last line's time
    hint.advance(k_nothing, 10);
    return { grips_s, pulled_m, hintFollows: hints >= 3, hintGone: hint.text === '' };
}

/** How many of the strangers grip and pull themselves, and for how many the hint went through its lines and is gone. */
async function playStrangers(context, scene, spawnName, farther_m = 0) {
    const world = handhold.createWorld();
    const level = await loadLevel(handhold, world, pathToFileURL(join(page, scene, 'scene.json')), () => {});
    const spawn = level.spawns.find((one) => one.name === spawnName);
    startBeforeSomethingToGrip(spawn, scene);
    const start = { position: spawn.position, rotation: spawn.rotation };
    world.setTuning('locomotion.thruster_mps2', 1.5);
    const player = world.addPlayer({ name: 'player0', origin: start });
    for (const side of [HH_LEFT, HH_RIGHT]) {
        world.setHandInController(player, side, {});
    }
    const begin = world.save();
    const minutes = [];
    for (let seed = 0; seed < k_strangers; ++seed) {
        world.restore(begin);
        minutes.push(playStranger(world, player, start, 530 + seed, farther_m));
    }
    const count = (test) => minutes.filter(test).length;
    const counts = {
        pull: count(({ grips_s, pulled_m }) => grips_s >= 0 && pulled_m > 0.2),
        hintFollows: count(({ hintFollows }) => hintFollows),
        hintGone: count(({ hintGone }) => hintGone),
    };
    context.diagnostic(`${scene}: ${count(({ grips_s }) => grips_s >= 0)} of ${k_strangers} strangers grip within ${k_seconds} s, ${counts.pull} pull themselves; `
        + `the hint is gone for ${counts.hintGone}; first grips after ${minutes.map(({ grips_s }) => grips_s.toFixed(1)).join(' ')} s`);
    return counts;
}

test('twenty of twenty-four strangers grip and pull in the station', async (context) => {
    const counts = await playStrangers(context, 'station', 'hab');
    assert.ok(Object.values(counts).every((count) => count >= k_needed), JSON.stringify(counts));
});
test('twenty of twenty-four strangers grip and pull in the playground', async (context) => {
    const counts = await playStrangers(context, 'playground', 'locker');
    assert.ok(Object.values(counts).every((count) => count >= k_needed), JSON.stringify(counts));
});
test('nobody grips far from everything, and the hint stays as it is', async (context) => {
    assert.deepEqual(await playStrangers(context, 'station', 'hab', 60), { pull: 0, hintFollows: 0, hintGone: 0 });
});

test('the hint says what comes next until somebody has pulled, and goes away for good', () => {
    const after = (hint, seen, frames) => {
        for (let frame = 0; frame < frames; ++frame) {
            hint.advance({ ...k_nothing, ...seen }, k_dt_s);
        }
        return hint.text;
    };
    const [green, gripping, pulling] = [{ canReach: true }, { grips: true }, { grips: true, moved_m: 0.01 }];
    const hint = new FirstHint();
    assert.match(after(hint, {}, 6000), /look at/);
    assert.match(after(hint, green, 6000), /mouse button/);
    assert.match(after(hint, gripping, 6000), /pull/);
    for (let grip = 0; grip < 20; ++grip) { // way of several grips does not add up, and floating is no pull
        assert.match(after(hint, pulling, 10), /pull/);
        assert.match(after(hint, { moved_m: 0.5 }, 10), /look at/);
    }
    assert.match(after(hint, pulling, 60), /Let go/);
    assert.match(after(hint, {}, 90), /Let go/); // long enough to be read
    for (const seen of [{}, green, pulling]) {
        assert.equal(after(hint, seen, 900), '');
    }
});
