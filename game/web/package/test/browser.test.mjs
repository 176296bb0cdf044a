// The package in a real browser: headless Chromium plays the scene that Node plays, and must get the
// same hash. Skipped where there is no Chromium.
import assert from 'node:assert/strict';
import { join, resolve } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { findChromium, inChromium } from './chromium.mjs';

test('Chromium gets the same hash as Node', { timeout: 120000 }, async (context) => {
    const chromium = findChromium();
    if (chromium === undefined) {
        context.skip('no chromium');
        return;
    }
    const inBrowser = await inChromium(chromium, 'return playSameScene(await handhold.loadHandhold(), handhold);');
    assert.equal(inBrowser.error, undefined);
    const handhold = await import(pathToFileURL(join(resolve(process.env.HANDHOLD_PACKAGE), 'handhold.js')));
    const { playSameScene } = await import('./same_scene.mjs');
    const inNode = playSameScene(await handhold.loadHandhold(), handhold);
    context.diagnostic(`median step: Chromium ${inBrowser.step_us.toFixed(1)} us, Node ${inNode.step_us.toFixed(1)} us`);
    assert.equal(inBrowser.hash, inNode.hash);
    assert.deepEqual(inBrowser.grips, inNode.grips);
});
