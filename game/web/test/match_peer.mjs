// Programs and peers for tests of matches: native ones by HANDHOLD_BIN (the folder of `handhold`), and the page's peer in Node by
// HANDHOLD_PACKAGE (the npm package) and HANDHOLD_MATCH (match.wasm).
import { spawn, spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, symlinkSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

export const game = join(resolve(process.env.HANDHOLD_BIN), 'handhold');
export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** Null, or why matches cannot be tested here. */
export function whyNot() {
    const probe = spawnSync(game, ['run', '--join', 'ws://127.0.0.1:1'], { encoding: 'utf8' });
    if (probe.error !== undefined || probe.stderr.includes('built with libwebsockets')) {
        return 'no native game with libwebsockets';
    }
    return socketType() === undefined ? 'no WebSocket in this Node: --experimental-websocket' : null;
}
export function socketType() {
    if (globalThis.WebSocket !== undefined) {
        return globalThis.WebSocket;
    }
    try {
        return createRequire(join(resolve(process.env.HANDHOLD_NPM ?? '.'), 'x.js'))('ws');
    } catch {
        return undefined;
    }
}

/** A program of the native game and the lines of its log, as objects. */
export class Program {
    constructor(context, ...words) {
        this.log = [];
        this.err = '';
        this.process = spawn(game, words.map(String));
        this.process.stderr.setEncoding('utf8').on('data', (text) => { this.err += text; });
        createInterface({ input: this.process.stdout }).on('line', (line) => {
            this.log.push(Object.fromEntries([...line.matchAll(/(\w+)=("[^"]*"|\S+)/g)].map(([, name, value]) => [name, value])));
        });
        this.ended = new Promise((done) => this.process.on('exit', done));
        context.after(() => this.process.kill('SIGKILL'));
    }
    lines(event) {
        return this.log.filter((line) => line.event === event);
    }
    async waitFor(event, count = 1) {
        for (let i = 0; this.lines(event).length < count; ++i) {
            if (i > 6000 || this.process.exitCode !== null) {
                throw new Error(`no ${count} times "${event}": ${this.err}`);
            }
            await sleep(10);
        }
        return this.lines(event)[count - 1];
    }
    async end(signal = 'SIGTERM') {
        this.process.kill(signal);
        return this.ended;
    }
}

/** The page's module match.js, in a folder where 'handhold' is the package. */
export async function loadPeerModule() {
    const folder = mkdtempSync(join(tmpdir(), 'handhold-match-'));
    process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
    mkdirSync(join(folder, 'node_modules'));
    symlinkSync(resolve(process.env.HANDHOLD_PACKAGE), join(folder, 'node_modules', 'handhold'));
    copyFileSync(new URL('../demo/match.js', import.meta.url), join(folder, 'match.mjs'));
    const module = await import(pathToFileURL(join(folder, 'match.mjs')));
    const settings = { module: pathToFileURL(resolve(process.env.HANDHOLD_MATCH)), WebSocketType: socketType() };
    return (url, more = {}) => module.joinMatch(url, { ...settings, ...more });
}

/** What somebody does who flies down to the hall's wall by jets and grips it again and again there. */
export function fallAndGrip(time_s) {
    const wave = 0.05 * Math.sin(3 * time_s);
    const hand = (x) => ({ position: { x, y: 1.4 + wave, z: -0.35 + wave }, rotation: { x: 0, y: 0, z: 0, w: 1 } });
    const grab = time_s % 1.2 > 0.4;
    return {
        sample: { time_s: 0, head: { position: { x: 0, y: 1.6, z: 0 } }, hands: [hand(-0.25), hand(0.25)], grab: [grab, grab] },
        commands: { thrust: { x: 0, y: time_s < 12 ? -1 : 0, z: 0 } },
    };
}

/** Plays for so many seconds. Returns hashes by tick, of every 180th confirmed tick, and what was seen. */
export async function playOn(match, seconds, devices = fallAndGrip) {
    const hashes = new Map();
    const seen = { gripping: 0, ticks: 0, slowest_ms: 0, stages: new Set() };
    const begin = performance.now();
    while (performance.now() < begin + 1e3 * seconds && !match.isOver) {
        const before = performance.now();
        seen.ticks += match.poll(devices(1e-3 * (before - begin)));
        seen.slowest_ms = Math.max(seen.slowest_ms, performance.now() - before);
        seen.stages.add(match.stage);
        const stats = match.stats();
        if (stats !== null && match.stage === 'playing') {
            const tick = stats.confirmed / 180n * 180n;
            const hash = tick > 0n ? match.hash(tick) : null;
            if (hash !== null) {
                hashes.set(String(tick), hash);
            }
            seen.gripping += match.world.playerPose(match.player).hands.some(({ grip }) => grip !== 0) ? 1 : 0;
        }
        await sleep(5);
    }
    return { hashes, seen };
}

/** How many ticks have an equal hash here and in the log; throws where one differs. */
export function equalHashes(hashes, program) {
    let equal = 0;
    for (const { tick, hash } of program.lines('confirmed')) {
        if (hashes.has(tick)) {
            if (hashes.get(tick) !== hash) {
                throw new Error(`tick ${tick}: ${hashes.get(tick)} here, ${hash} there`);
            }
            ++equal;
        }
    }
    return equal;
}
