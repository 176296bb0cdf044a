// Programs and peers for tests of matches: native ones by HANDHOLD_BIN (the folder of `handhold`), and the page's peer in Node by
// HANDHOLD_PACKAGE (the npm package) and HANDHOLD_MATCH (match.wasm). With HANDHOLD_MATCH_REQUIRED=1 tests that cannot run fail.
import { spawn, spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, symlinkSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';

export const game = join(resolve(process.env.HANDHOLD_BIN), 'handhold');
// The peers of HANDHOLD_PEERS, as [name, [program, argument...]]: a list of NAME=WORDS by semicolons, with a tab between two words.
export const namedPeers = (process.env.HANDHOLD_PEERS ?? '').split(';').filter((one) => one !== '')
    .map((one) => [one.slice(0, one.indexOf('=')), one.slice(one.indexOf('=') + 1).split('\t')]);
export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** Null, or why matches cannot be tested here; with HANDHOLD_MATCH_REQUIRED=1 throws that. */
export function whyNot() {
    const why = findObstacle();
    if (why !== null && process.env.HANDHOLD_MATCH_REQUIRED === '1') {
        throw new Error(why);
    }
    return why;
}
function findObstacle() {
    const probe = spawnSync(game, ['run', '--join', 'ws://127.0.0.1:1'], { encoding: 'utf8' });
    if (probe.error !== undefined || probe.stderr.includes('built with libwebsockets')) {
        return 'no native game with libwebsockets';
    }
    return socketType() === undefined ? 'no WebSocket in this Node: --experimental-websocket from 20.10 on, or the package "ws" (Debian: node-ws)' : null;
}
/** Node's own WebSocket, else that of the package "ws" in HANDHOLD_NPM or NODE_PATH; undefined without any. */
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

/** Also by a signal. */
const hasEnded = (process) => process.exitCode !== null || process.signalCode !== null;

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
            if (i > 6000 || hasEnded(this.process)) {
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

/** The server's first message. */
export const readOffer = (url) => new Promise((done) => {
    const socket = new (socketType())(url, 'handhold-match');
    socket.binaryType = 'arraybuffer';
    socket.onmessage = ({ data }) => { socket.close(); done(new Uint8Array(data)); };
});

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

/** A program of tests/portability/match_peer.cpp, for which this one carries the messages. */
export class DrivenPeer {
    static #persons = 0; // the server takes two players with one number for the same person
    #answers = Buffer.alloc(0);
    #wake = () => {};
    hashes = new Map();
    report = {};

    constructor(context, name, command) {
        this.name = name;
        const person = ++DrivenPeer.#persons;
        this.process = spawn(command[0], [...command.slice(1), String(person)], { stdio: ['pipe', 'pipe', 'inherit'] });
        this.process.stdout.on('data', (data) => {
            this.#answers = Buffer.concat([this.#answers, data]);
            this.#wake();
        });
        this.process.stdin.on('error', () => {});
        context.after(() => this.process.kill('SIGKILL'));
    }
    #ask(request, bytes, now_s) {
        const head = Buffer.alloc(bytes === undefined ? 9 : 5);
        head.write(request);
        if (bytes === undefined) {
            head.writeDoubleLE(now_s, 1);
        } else {
            head.writeUInt32LE(bytes.length, 1);
        }
        this.process.stdin.write(bytes === undefined ? head : Buffer.concat([head, bytes]));
    }
    async #take(size) {
        while (this.#answers.length < size) {
            if (hasEnded(this.process)) {
                throw new Error(`${this.name} has ended`);
            }
            await Promise.race([new Promise((done) => { this.#wake = done; }), sleep(1000)]);
        }
        const taken = this.#answers.subarray(0, size);
        this.#answers = this.#answers.subarray(size);
        return taken;
    }
    async #takeBytes() {
        return this.#take((await this.#take(4)).readUInt32LE());
    }
    /** Loads the level of the server's offer. Throws the reason if it cannot. */
    async load(offer) {
        this.#ask('L', offer);
        const why = (await this.#takeBytes()).toString();
        if (why !== '') {
            throw new Error(`${this.name}: ${why}`);
        }
    }
    /** Plays until `until_ms` of performance.now(). */
    async play(url, until_ms) {
        const socket = new (socketType())(url, 'handhold-match');
        socket.binaryType = 'arraybuffer';
        const now_s = () => 1e-3 * performance.now();
        this.#ask('C', undefined, now_s());
        socket.onmessage = ({ data }) => this.#ask('M', Buffer.from(data));
        while (performance.now() < until_ms) {
            this.#ask('P', undefined, now_s());
            const count = (await this.#take(4)).readUInt32LE();
            for (let i = 0; i < count; ++i) {
                const message = await this.#takeBytes();
                if (socket.readyState === 1) {
                    socket.send(Uint8Array.from(message));
                }
            }
            const numbers = await this.#take(56);
            const [stage, ticks, rollbacks, states, gripping, hashTick, hash] = Array.from({ length: 7 }, (_, i) => numbers.readBigUInt64LE(8 * i));
            this.report = { stage, ticks, rollbacks, states, gripping };
            if (hash !== 0n && hashTick > 0n) {
                this.hashes.set(String(hashTick), `0x${hash.toString(16).padStart(16, '0')}`);
            }
            await sleep(4);
        }
        socket.close();
    }
}
