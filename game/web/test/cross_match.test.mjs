// One match of peers for different processors and systems: the native game's, the page's module, and those of HANDHOLD_PEERS
// (tests/portability/match_peer.cpp). Other variables: match_peer.mjs. HANDHOLD_SECONDS: length, default 10.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { DrivenPeer, equalHashes, loadPeerModule, namedPeers as peers, playOn, Program, readOffer, whyNot } from './match_peer.mjs';

const skip = whyNot() ?? (peers.length === 0 ? 'HANDHOLD_PEERS names no peers' : false);

test('peers on other targets have the hashes of the native server', { skip, timeout: 900000 }, async (context) => {
    const seconds = Number(process.env.HANDHOLD_SECONDS ?? 10);
    const joinMatch = await loadPeerModule();
    const server = new Program(context, 'serve', '--scene', 'arena', '--players', peers.length + 2);
    const { url } = await server.waitFor('serves');
    const offer = await readOffer(url);
    const driven = peers.map(([name, command]) => new DrivenPeer(context, name, command));
    for (const peer of driven) {
        await peer.load(offer);
    }
    const page = await joinMatch(url);
    const bot = new Program(context, 'bots', 1, '--join', url);
    await bot.waitFor('plays');
    const until_ms = performance.now() + 1e3 * seconds;
    const [{ hashes, seen }] = await Promise.all([playOn(page, seconds), ...driven.map((peer) => peer.play(url, until_ms))]);
    await server.end();
    const all = [['page', hashes], ...driven.map((peer) => [peer.name, peer.hashes])];
    const equal = all.map(([name, of]) => [name, equalHashes(of, server)]);
    context.diagnostic(`${seconds} s, hashes equal to the server's: ${equal.map((one) => one.join(' ')).join(', ')}, native bot ${bot.lines('confirmed').length}`);
    for (const { name, report } of driven) {
        context.diagnostic(`${name}: ${Object.entries(report).map(([what, count]) => `${what} ${count}`).join(', ')}`);
        assert.ok(report.ticks > 20n * BigInt(seconds), name); // an emulator may be too slow to go ahead of the server, and so to go back
    }
    assert.ok(seen.gripping > 20 && page.stats().rollbacks > BigInt(seconds), `${seen.gripping}, ${page.stats().rollbacks}`);
    assert.ok(equal.every(([, count]) => count >= seconds / 2 - 3 && count > 0), equal.join());
    assert.equal(server.lines('ends')[0].out_of_sync, '0');
});
