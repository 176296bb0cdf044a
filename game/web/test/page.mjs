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
