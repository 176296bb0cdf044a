// The page plays a recorded session in Chromium; path and hash must equal those of the native game. `node --test` with
// the variables of page.mjs, and HANDHOLD_BIN: a folder with the native handhold and handhold-scenes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { withPage } from './page.mjs';

// {hash, path}: the play space's position after each frame.
function playNatively(scene, recording) {
    const folder = mkdtempSync(join(tmpdir(), 'handhold-native-'));
    try {
        execFileSync(join(process.env.HANDHOLD_BIN, 'handhold'), ['run', '--scene', scene, '--input', recording, '--seconds', '31', '--out', join(folder, 'out'),
            '--no-pictures']);
        const said = execFileSync(join(process.env.HANDHOLD_BIN, 'handhold-scenes'), ['31', scene, recording], { encoding: 'utf8' });
        const [header, ...lines] = readFileSync(join(folder, 'out/frames.csv'), 'utf8').trim().split('\n');
        const columns = ['origin_x', 'origin_y', 'origin_z'].map((name) => header.split(',').indexOf(name));
        assert.ok(!columns.includes(-1), header);
        const path = lines.map((line) => columns.map((column) => Number(line.split(',')[column])));
        return { hash: said.split(' ')[1], path };
    } finally {
        rmSync(folder, { recursive: true });
    }
}

test('a recorded session: path and hash equal the native game\'s', { timeout: 550000 }, async (context) => {
    const native = playNatively('station', join(process.env.HANDHOLD_PAGE, 'station/session.csv'));
    await withPage('?recording=station/session.csv&seconds=31', async ({ page, errors }) => {
        await page.waitForFunction('demo.hash !== undefined', { timeout: 500000 });
        const path = await page.evaluate(() => demo.path.map(({ x, y, z }) => [x, y, z]));
        const differing = path.findIndex((at, i) => at.some((x, axis) => x !== native.path[i][axis]));
        assert.equal(differing, -1, `step ${differing}: ${path[differing]}, native ${native.path[differing]}`);
        assert.equal(path.length, native.path.length);
        const moved_m = path.slice(1).reduce((sum, at, i) => sum + Math.hypot(...at.map((x, axis) => x - path[i][axis])), 0);
        assert.ok(moved_m > 1, `moved ${moved_m} m`);
        assert.equal(await page.evaluate(() => demo.hash), native.hash);
        assert.deepEqual(errors, []);
        context.diagnostic(`${path.length} steps, ${moved_m.toFixed(1)} m, ${native.hash}, median step ${await page.evaluate(() => demo.panel.median_us)} us`);
        if (process.env.HANDHOLD_PICTURES) {
            await page.screenshot({ path: join(process.env.HANDHOLD_PICTURES, 'recording.png') });
        }
    }, { viewport: { width: 800, height: 500 } });
});
