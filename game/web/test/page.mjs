// Opens the page in headless Chromium. Environment: HANDHOLD_PAGE: the folder that tools/web makes;
// HANDHOLD_NPM: node_modules with puppeteer-core and iwer (npm install puppeteer-core iwer).
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { serveFolder } from '../serve.mjs';

export const npm = resolve(process.env.HANDHOLD_NPM);
const puppeteer = createRequire(join(npm, 'x.js'))('puppeteer-core');

/** Serves the page, opens it with `query` and calls work({page, errors, server}). errors: what the console said. script: runs before the page's. */
export async function withPage(query, work, { script = '', viewport = { width: 320, height: 200 }, jsFlags = '' } = {}) {
    const server = await serveFolder(process.env.HANDHOLD_PAGE, 0);
    const browser = await puppeteer.launch({
        executablePath: '/usr/bin/chromium', headless: true, protocolTimeout: 1800000,
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', `--js-flags=${jsFlags}`],
    });
    try {
        const page = await browser.newPage();
        const errors = [];
        page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
        page.on('pageerror', (error) => errors.push(error.message));
        await page.setViewport(viewport);
        await page.evaluateOnNewDocument(script);
        await page.goto(`http://127.0.0.1:${server.address().port}/${query}`);
        await page.waitForFunction('window.demo?.isReady', { timeout: 300000 });
        await work({ page, errors, server });
    } finally {
        await browser.close();
        server.close();
        server.closeAllConnections();
    }
}

/** In a match: the player flies to a wall and grips there, again and again. Returns [tick, hash] of confirmed ticks, and what was seen. */
export const playInPage = (page, length_s) => page.evaluate(async (wanted_s) => {
    const hashes = new Map();
    let gripping = 0;
    demo.desktop.keys.add('KeyQ');
    for (let i = 0; i < 20 * wanted_s; ++i) {
        demo.desktop.pitch = -1.2;
        demo.desktop.pressed.fill(i % 40 > 10);
        if (i === 140) {
            demo.desktop.keys.clear();
        }
        await new Promise((done) => setTimeout(done, 50));
        const tick = demo.match.stats().confirmed / 180n * 180n;
        const hash = tick > 0n ? demo.match.hash(tick) : null;
        if (hash !== null) {
            hashes.set(String(tick), hash);
        }
        gripping += demo.world.playerPose(demo.player).hands.some(({ grip }) => grip !== 0) ? 1 : 0;
    }
    const { ticks, rollbacks, filled, deepest } = demo.match.stats();
    return { hashes: [...hashes], gripping, ticks: Number(ticks), rollbacks: Number(rollbacks), filled: Number(filled), deepest: Number(deepest) };
}, length_s);
