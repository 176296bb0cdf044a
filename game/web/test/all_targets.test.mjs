// One match of the arena: two native peers, by QUIC and by WebSocket, the page in Chromium, and the peers of HANDHOLD_PEERS on other processors
// and systems; skipped if that is not set. Other variables: page.mjs, match_peer.mjs. HANDHOLD_SECONDS: so much of the match must
// be compared on each machine, default 60. HANDHOLD_PICTURES: folder for a picture of the page. See .ci/all_targets.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { DrivenPeer, equalHashes, namedPeers as peers, Program, readOffer, whyNot } from './match_peer.mjs';
import { playInPage, withPage } from './page.mjs';

const skip = whyNot() ?? (process.env.HANDHOLD_PEERS === undefined ? 'HANDHOLD_PEERS is not set' : false);
const seconds = Number(process.env.HANDHOLD_SECONDS ?? 60);
const hashEvery_s = 2; // 180 ticks

test('native peers, a page and peers on other targets play one match: equal hashes', { skip, timeout: 900000 }, async (context) => {
    assert.ok(peers.length > 0, 'HANDHOLD_PEERS names no peers');
    const server = new Program(context, 'serve', '--scene', 'arena', '--players', peers.length + 3);
    const { url, quic } = await server.waitFor('serves');
    const driven = peers.map(([name, command]) => new DrivenPeer(context, name, command));
    const offer = await readOffer(url);
    for (const peer of driven) {
        await peer.load(offer);
    }
    const native = [url, quic.replaceAll('"', '')].map((one) => new Program(context, 'bots', 1, '--join', one));
    await server.waitFor('plays', 2);
    let page;
    await withPage(`?join=${encodeURIComponent(url)}`, async (opened) => {
        assert.equal(await opened.page.evaluate(() => demo.error), undefined);
        const length_s = seconds + 4 * hashEvery_s; // a hash's tick may be missed
        const until_ms = performance.now() + 1e3 * length_s;
        [page] = await Promise.all([playInPage(opened.page, length_s), ...driven.map((peer) => peer.play(url, until_ms))]);
        if (process.env.HANDHOLD_PICTURES) {
            await opened.page.screenshot({ path: join(process.env.HANDHOLD_PICTURES, 'all_targets_page.png') });
        }
        assert.deepEqual(opened.errors, []);
    }, { viewport: process.env.HANDHOLD_PICTURES ? { width: 960, height: 540 } : { width: 320, height: 200 } });
    assert.equal(await server.end(), 0);
    const ends = server.lines('ends')[0];
    const machines = [['page', new Map(page.hashes)], ...driven.map((peer) => [peer.name, peer.hashes]),
        ...native.map((program, i) => [['native WebSocket', 'native QUIC'][i], new Map(program.lines('confirmed').map(({ tick, hash }) => [tick, hash]))])];
    const compared_s = machines.map(([name, hashes]) => [name, hashEvery_s * equalHashes(hashes, server)]);
    context.diagnostic(`seconds with equal hashes: ${compared_s.map((one) => one.join(' ')).join(', ')}; by the server: ${ends.hashes}, different ${ends.out_of_sync}, score ${ends.score}`);
    context.diagnostic(`page: ticks ${page.ticks}, rollbacks ${page.rollbacks}, filled ${page.filled}, gripping ${page.gripping}`);
    for (const { name, report } of driven) {
        context.diagnostic(`${name}: ${Object.entries(report).map(([what, count]) => `${what} ${count}`).join(', ')}`);
        assert.ok(report.gripping > 0n, `${name} never gripped`);
    }
    assert.ok(compared_s.every(([, length]) => length >= seconds), compared_s.join('; '));
    assert.ok(page.gripping > 5, 'the page never gripped');
    assert.ok(page.rollbacks > seconds, `${page.rollbacks}`);
    assert.equal(ends.out_of_sync, '0');
    assert.ok(Number(ends.hashes) >= machines.length * seconds / 4, ends.hashes);
});
