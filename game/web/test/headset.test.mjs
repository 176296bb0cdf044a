// The page in headless Chromium with an emulated headset: `node --test` with the variables of page.mjs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { npm, withPage } from './page.mjs';

const emulator = readFileSync(join(npm, 'iwer/build/iwer.min.js'), 'utf8') + `;
    window.emulated = new IWER.XRDevice(IWER.metaQuest3);
    emulated.installRuntime({ forceInstall: true });
    // The emulator says that the positions of its controllers are guesses, and the page does not grip with those.
    Object.defineProperty(XRPose.prototype, 'emulatedPosition', { get: () => false });
    emulated.position.set(0, 1.6, 0);
    emulated.controllers.left.position.set(-0.25, 1.35, -0.3);
    emulated.controllers.right.position.set(0.25, 1.35, -0.3);`;

// In the page. Lays the right palm on the wall to the right, closes the hand, pulls, and says what happened.
async function crawl() {
    const frames = async (count) => {
        const end = demo.panel.frames + count;
        while (demo.panel.frames < end) {
            await new Promise((resolve) => setTimeout(resolve, 5));
        }
    };
    const { Raycaster, Vector3 } = await import('three');
    const right = window.emulated.controllers.right;
    const state = () => demo.world.playerPose(demo.player);
    const say = (hand) => ({ grip: hand.grip, name: demo.level.names.get(hand.body.index), error_m: hand.error_m });
    await frames(3);
    // The play space has the world's axes at this spawn.
    const { position } = state().origin;
    const from = new Vector3(position.x + 0.25, position.y + 1.35, position.z - 0.3);
    const hit = new Raycaster(from, new Vector3(1, 0, 0)).intersectObjects(demo.level.scene.children, true)[0];
    right.quaternion.set(0, 0, 1, 0); // the palm faces +X
    right.position.set(0.25 + hit.distance - 0.05, 1.35, -0.3);
    await frames(4);
    right.updateButtonValue('squeeze', 1);
    await frames(6);
    const gripped = state();
    right.position.z += 0.2;
    await frames(12);
    const pulled = state();
    return { hand: say(pulled.hands[1]), moved_m: pulled.origin.position.z - gripped.origin.position.z, wall_m: hit.distance };
}

test('a controller grips the station and pulls the player', { timeout: 550000 }, async (context) => {
    await withPage('?spawn=hab', async ({ page, errors }) => {
        assert.equal(await page.$eval('#enter', (button) => button.disabled), false);
        await page.$eval('#enter', (button) => button.click());
        await page.waitForFunction('demo.renderer.xr.isPresenting', { timeout: 60000 });
        const said = await page.evaluate(crawl);
        context.diagnostic(JSON.stringify(said));
        assert.deepEqual(errors, []);
        assert.notEqual(said.hand.grip, 0);
        assert.ok(said.hand.error_m < 1e-6);
        assert.ok(Math.abs(said.moved_m + 0.2) < 1e-3, `moved ${said.moved_m} m`);
        context.diagnostic(`median step ${await page.evaluate(() => demo.panel.median_us)} us`);
        if (process.env.HANDHOLD_PICTURES) {
            await page.screenshot({ path: join(process.env.HANDHOLD_PICTURES, 'headset.png') });
        }
    }, { script: emulator });
});
