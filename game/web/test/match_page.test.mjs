// The page in matches of the native `handhold serve`: `node --test` with the variables of page.mjs, and HANDHOLD_BIN.
// HANDHOLD_SECONDS: length of the match, default 10. HANDHOLD_PICTURES: folder for pictures.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { equalHashes, Program, whyNot } from './match_peer.mjs';
import { playInPage, withPage } from './page.mjs';

const skip = whyNot() ?? false;
const seconds = Number(process.env.HANDHOLD_SECONDS ?? 10);
async function serve(context, ...words) {
    const server = new Program(context, 'serve', ...words);
    return { server, url: (await server.waitFor('serves')).url };
}
const query = (url) => `?join=${encodeURIComponent(url)}`;

test('the page plays in the arena with two native bots: equal hashes', { skip, timeout: 400000 }, async (context) => {
    const { server, url } = await serve(context, '--scene', 'arena', '--players', 4);
    const bots = new Program(context, 'bots', 2, '--join', url);
    await server.waitFor('plays', 2);
    await withPage(query(url), async ({ page, errors }) => {
        assert.equal(await page.evaluate(() => demo.error), undefined);
        const seen = await playInPage(page, seconds);
        if (process.env.HANDHOLD_PICTURES) {
            await page.evaluate(() => { // the bots, from where the player is
                const [{ head }, ...others] = [demo.player, ...demo.match.players].map((id) => demo.world.playerPose(id));
                const to = others.map((one) => one.head.position).find((at) => Math.hypot(at.x - head.position.x, at.z - head.position.z) > 0.5);
                const back = demo.world.playerPose(demo.player).origin.rotation;
                const half = Math.atan2(-(to.x - head.position.x), -(to.z - head.position.z)) - 2 * Math.atan2(back.y, back.w);
                demo.desktop.pressed.fill(false);
                demo.desktop.yaw = half;
                demo.desktop.pitch = 0.2;
            });
            await new Promise((done) => setTimeout(done, 1500));
            await page.screenshot({ path: join(process.env.HANDHOLD_PICTURES, 'match_page.png') });
        }
        const hashes = new Map(seen.hashes);
        const equal = [server, bots].map((program) => equalHashes(hashes, program));
        context.diagnostic(`${seen.ticks} ticks, ${seen.rollbacks} rollbacks, deepest ${seen.deepest}, ${seen.filled} filled, gripping in ${seen.gripping} looks, `
            + `hashes equal: ${equal} of ${hashes.size}`);
        assert.ok(equal.every((count) => count >= seconds / 2 - 3 && count > 0), `${equal}`);
        assert.ok(seen.rollbacks > seconds, `${seen.rollbacks}`);
        assert.ok(seen.gripping > 5, `${seen.gripping}`);
        await page.waitForFunction(() => document.getElementById('figures').innerText !== '', { timeout: 120000 }); // pictures may be slow
        const panel = await page.$eval('#figures', (table) => table.innerText);
        for (const word of ['score', 'blue', 'player 3 of 4', 'tracked players', 'step, median']) {
            assert.ok(panel.includes(word), panel);
        }
        assert.deepEqual(errors, []);
    }, { viewport: process.env.HANDHOLD_PICTURES ? { width: 960, height: 540 } : { width: 320, height: 200 } });
    assert.equal(await server.end(), 0);
    assert.equal(server.lines('ends')[0].out_of_sync, '0');
});

test('the field joins, and a page that cannot join says why', { skip, timeout: 300000 }, async (context) => {
    const { server, url } = await serve(context, '--scene', 'reach', '--players', 2);
    await withPage('?scene=playground', async ({ page }) => {
        await page.evaluate((address) => { document.querySelector('#join input').value = address; }, url);
        await Promise.all([page.waitForNavigation(), page.click('#join button')]);
        await page.waitForFunction('window.demo?.isReady', { timeout: 300000 });
        assert.equal(await page.evaluate(() => demo.match.scene), 'reach');
        assert.equal((await server.waitFor('plays')).slot, '0');
        await page.reload();
        await page.waitForFunction('window.demo?.isReady', { timeout: 300000 });
        assert.equal(await page.evaluate(() => demo.match.slot), 0); // the same person
        await server.end();
        await page.waitForFunction('demo.match.isOver', { timeout: 20000 });
        await page.waitForFunction(() => document.getElementById('help').innerText.includes('the server is shutting down'), { timeout: 20000 });
        await page.reload();
        await page.waitForFunction('window.demo?.isReady', { timeout: 300000 });
        const said = await page.$eval('#loading', (element) => element.innerText);
        assert.ok(said.includes('no server') && said.includes(url) && said.includes('Play alone'), said);
    });
});
