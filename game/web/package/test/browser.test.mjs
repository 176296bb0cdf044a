// The package in a real browser: headless Chromium plays the scene that Node plays, and must get the
// same hash. Skipped where there is no Chromium.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = resolve(process.env.HANDHOLD_PACKAGE);
const types = { html: 'text/html', js: 'text/javascript', mjs: 'text/javascript', wasm: 'application/wasm' };
const page = `<!doctype html><title>handhold</title><script type="module">
const say = (said) => fetch('/said', { method: 'POST', body: JSON.stringify(said) });
addEventListener('error', (event) => say({ error: event.message }));
try {
    const handhold = await import('/package/handhold.js');
    const { playSameScene } = await import('/test/same_scene.mjs');
    await say(playSameScene(await handhold.loadHandhold(), handhold));
} catch (error) {
    await say({ error: String(error.stack) });
}
</script>`;

// Serves the page on the loopback; resolves with what it posts.
function serve() {
    let hear;
    const said = new Promise((resolve) => { hear = resolve; });
    const server = createServer((request, response) => {
        const [, root, name] = request.url.match(/^\/(package|test)\/([\w.]+)$/) ?? [];
        if (request.method === 'POST') {
            let body = '';
            request.on('data', (part) => { body += part; });
            request.on('end', () => { response.end(); hear(JSON.parse(body)); });
        } else if (root !== undefined) {
            response.setHeader('content-type', types[name.split('.').pop()]);
            response.end(readFileSync(root === 'package' ? join(folder, name) : new URL(name, import.meta.url)));
        } else {
            response.setHeader('content-type', 'text/html');
            response.end(page);
        }
    });
    return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve({ server, said })));
}

function findChromium() {
    try {
        return execFileSync('sh', ['-c', 'command -v chromium || command -v google-chrome'], { encoding: 'utf8' }).trim();
    } catch {
        return undefined;
    }
}

test('Chromium gets the same hash as Node', { timeout: 120000 }, async (context) => {
    const chromium = findChromium();
    if (chromium === undefined) {
        context.skip('no chromium');
        return;
    }
    const { server, said } = await serve();
    const profile = mkdtempSync(join(tmpdir(), 'handhold-chromium-'));
    const browser = spawn(chromium, ['--headless', '--no-sandbox', '--disable-gpu', '--disable-extensions', '--no-first-run',
        `--user-data-dir=${profile}`, `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
    const ended = new Promise((resolve) => browser.on('exit', resolve));
    try {
        const inBrowser = await Promise.race([said, ended.then((status) => ({ error: `chromium ended with ${status}` }))]);
        assert.equal(inBrowser.error, undefined);
        const handhold = await import(pathToFileURL(join(folder, 'handhold.js')));
        const { playSameScene } = await import('./same_scene.mjs');
        const inNode = playSameScene(await handhold.loadHandhold(), handhold);
        context.diagnostic(`median step: Chromium ${inBrowser.step_us.toFixed(1)} us, Node ${inNode.step_us.toFixed(1)} us`);
        assert.equal(inBrowser.hash, inNode.hash);
        assert.deepEqual(inBrowser.grips, inNode.grips);
    } finally {
        browser.kill();
        await ended;
        server.close();
        rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
    }
});
