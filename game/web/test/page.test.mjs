// The page as a desktop player has it, and its memory. `node --test` with the variables of page.mjs;
// HANDHOLD_MINUTES: played time of the memory test, default 10.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { withPage } from './page.mjs';

const frames = (page, count) => page.evaluate(async (wanted) => {
    const end = demo.panel.frames + wanted;
    while (demo.panel.frames < end) {
        await new Promise((resolve) => setTimeout(resolve, 5));
    }
}, count);

for (const scene of ['station', 'playground']) {
    test(`${scene}: the climber climbs, the panel tells, and all works offline once loaded`, { timeout: 550000 }, async () => {
        await withPage(`?scene=${scene}&spawn=${{ station: 'hab', playground: 'locker' }[scene]}`, async ({ page, errors, server }) => {
            const wire = await page.evaluate(() => performance.getEntriesByType('resource').reduce((sum, one) => sum + one.transferSize, 0));
            assert.ok(wire > 1e6 && wire < 6e6, `${wire} bytes on the wire`);
            const climber = () => page.evaluate(() => demo.world.playerPose(demo.climber.id).origin.position);
            const before = await climber();
            await page.evaluate(() => { document.getElementById('gizmos').checked = true; });
            for (let i = 0; i < 900; ++i) { // ten seconds of the climber's
                await page.evaluate(() => demo.advance(1 / 90, demo.desktop.read(1 / 90)));
            }
            await page.evaluate(() => { // look at the climber
                const { head } = demo.world.playerPose(demo.player);
                const to = demo.world.playerPose(demo.climber.id).head;
                const [x, y, z] = ['x', 'y', 'z'].map((axis) => to.position[axis] - head.position[axis]);
                demo.desktop.yaw = Math.atan2(-x, -z);
                demo.desktop.pitch = Math.atan2(y, Math.hypot(x, z));
            });
            await frames(page, 20);
            const after = await climber();
            const moved_m = Math.hypot(after.x - before.x, after.y - before.y, after.z - before.z);
            assert.ok(moved_m > 0.3, `the climber moved ${moved_m} m`);
            const panel = await page.$eval('#figures', (table) => table.innerText);
            for (const word of ['step, median', 'frame cost', 'hand error', 'left', 'right']) {
                assert.ok(panel.includes(word), panel);
            }
            if (process.env.HANDHOLD_PICTURES) {
                await page.screenshot({ path: join(process.env.HANDHOLD_PICTURES, `desktop_${scene}.png`) });
            }
            assert.equal(await page.evaluate(() => demo.isOffline), true);
            assert.deepEqual(errors, []);
            server.close();
            server.closeAllConnections();
            await page.reload();
            await page.waitForFunction('window.demo?.isReady', { timeout: 300000 });
            assert.ok(await page.evaluate(() => demo.level.names.size) > 20);
        }, { viewport: { width: 800, height: 500 } });
    });
}

// Steps and what is shown, without waiting for the screen; a garbage collection before each measurement.
test('memory stays as it is', { timeout: 1800000 }, async (context) => {
    const minutes = Number(process.env.HANDHOLD_MINUTES ?? 10);
    await withPage('?scene=station', async ({ page, errors }) => {
        const play = (seconds) => page.evaluate((wanted) => {
            demo.renderer.setAnimationLoop(null);
            for (let step = 0; step < 90 * wanted; ++step) {
                demo.advance(1 / 90, demo.desktop.read(1 / 90));
                if (step % 9 === 0) {
                    demo.show(1 / 90, 0);
                }
            }
            gc();
            return { wasm: demo.handhold.exports.memory.buffer.byteLength, heap: performance.memory.usedJSHeapSize };
        }, seconds);
        const figures = [await play(60)]; // the climber's session twice
        for (let minute = 1; minute < minutes; ++minute) {
            figures.push(await play(60));
        }
        const mb = ({ wasm, heap }) => `${(wasm / 2 ** 20).toFixed(2)} + ${(heap / 2 ** 20).toFixed(2)}`;
        context.diagnostic(`WebAssembly + JavaScript, MB, after each minute: ${figures.map(mb).join(', ')}`);
        assert.equal(figures.at(-1).wasm, figures[0].wasm);
        assert.ok(figures.at(-1).heap < figures[0].heap + 2 ** 20, 'the heap grew by more than 1 MB');
        assert.deepEqual(errors, []);
    }, { jsFlags: '--expose-gc', viewport: { width: 64, height: 64 } });
});
