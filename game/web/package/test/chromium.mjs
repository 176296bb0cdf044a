// Runs the package in headless Chromium.
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const folder = resolve(process.env.HANDHOLD_PACKAGE);
const types = { html: 'text/html', js: 'text/javascript', mjs: 'text/javascript', wasm: 'application/wasm' };

// The page runs the body of an async function, which sees `handhold`, the package's module, and `playSameScene`, and posts what it returns.
const pageOf = (body) => `<!doctype html><title>handhold</title><script type="module">
const say = (said) => fetch('/said', { method: 'POST', body: JSON.stringify(said) });
addEventListener('error', (event) => say({ error: event.message }));
try {
    const handhold = await import('/package/handhold.js');
    const { playSameScene } = await import('/test/same_scene.mjs');
    await say(await (async () => { ${body} })());
} catch (error) {
    await say({ error: String(error.stack) });
}
</script>`;

// Serves the page on the loopback; resolves with what it posts.
function serve(page) {
    let hear;
    const said = new Promise((resolve) => { hear = resolve; });
    const server = createServer((request, response) => {
        const [, root, name] = request.url.match(/^\/(package|test)\/([\w.-]+)$/) ?? [];
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

/** The command that starts Chromium, or undefined. */
export function findChromium() {
    try {
        return execFileSync('sh', ['-c', 'command -v chromium || command -v google-chrome'], { encoding: 'utf8' }).trim();
    } catch {
        return undefined;
    }
}

/** What `body` returns in a page, where it runs as an async function that sees `handhold` and `playSameScene`; {error} if it fails. */
export async function inChromium(chromium, body) {
    const { server, said } = await serve(pageOf(body));
    const profile = mkdtempSync(join(tmpdir(), 'handhold-chromium-'));
    const browser = spawn(chromium, ['--headless', '--no-sandbox', '--disable-gpu', '--disable-extensions', '--no-first-run',
        `--user-data-dir=${profile}`, `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
    const ended = new Promise((resolve) => browser.on('exit', resolve));
    try {
        return await Promise.race([said, ended.then((status) => ({ error: `chromium ended with ${status}` }))]);
    } finally {
        browser.kill();
        await ended;
        server.close();
        rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
    }
}
