// The page's peer in Node, in matches of the native `handhold serve`: `node --test` with the variables of match_peer.mjs.
// HANDHOLD_SECONDS: length of the match, default 10.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { equalHashes, game, loadPeerModule, playOn, Program, readOffer, sleep, socketType, whyNot } from './match_peer.mjs';

const skip = whyNot() ?? false;
const joinMatch = skip ? null : await loadPeerModule();
async function serve(context, ...words) {
    const server = new Program(context, 'serve', ...words);
    const { url } = await server.waitFor('serves');
    return { server, url };
}
async function enter(url, settings) {
    const match = await joinMatch(url, settings);
    for (let i = 0; match.stage !== 'playing' && !match.isOver && i < 1000; ++i) {
        match.poll({ sample: {} });
        await sleep(5);
    }
    return match;
}
const whyRefused = async (url, settings) => {
    try {
        const match = await enter(url, settings);
        return match.why;
    } catch (error) {
        return error.message;
    }
};

test('a peer in WebAssembly and two native bots have the hashes of the server, in the arena', { skip, timeout: 200000 }, async (context) => {
    const seconds = Number(process.env.HANDHOLD_SECONDS ?? 10);
    const { server, url } = await serve(context, '--scene', 'arena', '--players', 4);
    const match = await enter(url);
    assert.equal(match.stage, 'playing', match.why);
    assert.equal(match.slot, 0);
    const bots = new Program(context, 'bots', 2, '--join', url);
    const { hashes, seen } = await playOn(match, seconds);
    const stats = match.stats();
    // Between two ticks everybody and everything is drawn near to where it is stepped; the own head follows the newest sample.
    const apart_m = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    const bodies = match.world.bodies();
    const poses = match.world.bodyPoses(bodies);
    const drawnBodies = match.drawnBodies(bodies);
    assert.equal(drawnBodies.length, bodies.length);
    drawnBodies.forEach(({ position }, i) => assert.ok(apart_m(position, poses[i].position) < 0.5, `${i}`));
    match.players.forEach((id, slot) => {
        assert.ok(apart_m(match.drawnPlayer(slot).head.position, match.world.playerPose(id).head.position) < 0.5, `${slot}`);
    });
    const rotation = { x: 0, y: 0, z: 0, w: 1 };
    const devicesAt = (y, wrists) => ({
        sample: { head: { position: { x: 0, y, z: 0 }, rotation }, hands: [-0.3, 0.3].map((x) => ({ position: { x, y: 1, z: -0.3 }, rotation })) },
        usesWrists: [wrists, wrists],
    });
    const heads = [1, 1.5].map((y) => match.drawnPlayer(0, devicesAt(y, false)).head.position);
    assert.ok(Math.abs(apart_m(...heads) - 0.5) < 1e-9);
    // The wrist of a controller is beside it.
    const hands = [false, true].map((wrists) => match.drawnPlayer(0, devicesAt(1, wrists)).hands[0].position);
    const isEmpty = match.world.playerPose(match.player).hands[0].grip === 0;
    assert.ok(!isEmpty || apart_m(...hands) > 0.01, `${apart_m(...hands)}`);
    match.leave();
    const left = await server.waitFor('left');
    assert.equal(await server.end(), 0);
    assert.equal(await bots.ended, 0);
    const equal = [server, bots].map((program) => equalHashes(hashes, program));
    context.diagnostic(`${seen.ticks} ticks, ${stats.rollbacks} rollbacks, deepest ${stats.deepest}, ${stats.filled} filled, `
        + `gripping in ${seen.gripping} looks, hashes equal: ${equal} of ${hashes.size}, slowest poll ${seen.slowest_ms.toFixed(0)} ms, "${match.score}"`);
    assert.equal(left.why, 'leaving');
    assert.ok(equal.every((count) => count >= seconds / 2 - 3 && count > 0), `${equal}`);
    assert.ok(stats.rollbacks > 10n * BigInt(seconds), `${stats.rollbacks}`);
    assert.ok(seen.gripping > 20, `${seen.gripping}`);
    assert.equal(server.lines('ends')[0].out_of_sync, '0');
    assert.equal(match.score.split(' ').length, 5);
});

test('who is not admitted reads why in one line', { skip, timeout: 100000 }, async (context) => {
    const folder = mkdtempSync(join(tmpdir(), 'handhold-tokens-'));
    const file = (name) => join(folder, name);
    writeFileSync(file('key'), 'k'.repeat(40));
    writeFileSync(file('other'), 'x'.repeat(40));
    const token = (name, key, minutes = 10) => spawnSync(game, ['token', '--token-key', file(key), '--name', name, '--minutes', minutes], { encoding: 'utf8' }).stdout.trim();
    const { server, url } = await serve(context, '--scene', 'reach', '--players', 1, '--token-key', file('key'));
    assert.equal(await whyRefused(url), 'the server wants a token');
    assert.equal(await whyRefused(url, { token: token('ann', 'key', 0) }), 'the token has expired');
    assert.equal(await whyRefused(url, { token: token('ann', 'other') }), 'the token is not one of this server');
    const ann = await enter(url, { token: token('ann', 'key') });
    assert.equal(ann.stage, 'playing', ann.why);
    assert.equal(await whyRefused(url, { token: token('bob', 'key') }), 'the match is full');
    server.process.kill('SIGTERM');
    await playOn(ann, 5);
    assert.equal(ann.why, 'the server is shutting down');
    assert.ok(ann.isOver);
    assert.match(await whyRefused(url), /^no server: /);
    assert.match(await whyRefused('nonsense'), /expected ws:\/\/HOST:PORT/);
});

test('another version or level is named', { skip, timeout: 100000 }, async (context) => {
    const { url } = await serve(context, '--scene', 'reach', '--players', 2);
    const offer = await readOffer(url);
    // Stands for a server that says something else. Bytes 5, 6: version; from 17 on the digests, eight bytes each.
    const claim = (change) => class {
        constructor() {
            const said = offer.slice();
            change(said);
            setTimeout(() => this.onmessage({ data: said.buffer }), 1);
        }
        close() {}
    };
    assert.match(await whyRefused(url, { WebSocketType: claim((said) => { said[5] = 99; }) }), /^other version: the server speaks 99, this program \d+$/);
    for (const [index, name] of ['library', 'scene', 'tick', 'tuning', 'clips', 'bodies', 'shapes'].entries()) {
        assert.equal(await whyRefused(url, { WebSocketType: claim((said) => { said[17 + 8 * index] ^= 1; }) }), `other level: "${name}" differs`);
    }
    assert.equal(await whyRefused(url, { WebSocketType: claim((said) => { said[1] = 0; }) }), 'this is no server of matches');
    assert.equal(await whyRefused(url, { WebSocketType: claim((said) => { said[said.length - 1] = 0x21; }) }), 'the match is in "reac!", which is not built in');
});

test('a player comes back to the same slot after the connection was cut', { skip, timeout: 100000 }, async (context) => {
    const { server, url } = await serve(context, '--scene', 'reach', '--players', 2);
    const sockets = [];
    class Cut extends socketType() {
        constructor(...given) {
            super(...given);
            sockets.push(this);
        }
    }
    const match = await enter(url, { WebSocketType: Cut });
    await playOn(match, 1);
    sockets.at(-1).close();
    const { hashes, seen } = await playOn(match, 5);
    assert.ok(seen.stages.has('connecting') && match.stage === 'playing', [...seen.stages].join());
    assert.equal(match.states, 2);
    assert.equal(match.slot, 0);
    assert.ok(equalHashes(hashes, server) > 0);
    match.leave();
});

test('the same person from elsewhere takes over the slot', { skip, timeout: 100000 }, async (context) => {
    const { url } = await serve(context, '--scene', 'reach', '--players', 2);
    const before = await enter(url, { person: 5n });
    const after = await enter(url, { person: 5n });
    await playOn(before, 0.5);
    assert.ok(before.isOver);
    assert.equal(before.why, 'the same person has joined from elsewhere');
    assert.deepEqual([after.stage, after.slot], ['playing', 0]);
    after.leave();
});
