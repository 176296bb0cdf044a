// The page's server: what has a .gz beside it is sent compressed to those who accept it, and arrives as it was. Without a browser.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { get } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { gunzipSync, gzipSync } from 'node:zlib';
import { serveFolder } from '../serve.mjs';

const ask = (port, path, headers) => new Promise((resolve, reject) => {
    get({ port, host: '127.0.0.1', path, headers }, (response) => {
        const parts = [];
        response.on('data', (part) => parts.push(part));
        response.on('end', () => resolve({ status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) }));
    }).on('error', reject);
});

test('files are sent compressed to those who accept it', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'handhold-serve-'));
    const text = Buffer.from('a level, '.repeat(1000));
    writeFileSync(join(folder, 'level.json'), text);
    writeFileSync(join(folder, 'level.json.gz'), gzipSync(text));
    writeFileSync(join(folder, 'small.json'), '{}');
    const server = await serveFolder(folder, 0);
    const { port } = server.address();
    try {
        const packed = await ask(port, '/level.json', { 'accept-encoding': 'br, gzip' });
        assert.equal(packed.headers['content-encoding'], 'gzip');
        assert.equal(packed.headers['content-type'], 'application/json');
        assert.ok(packed.body.length < text.length / 10);
        assert.deepEqual(gunzipSync(packed.body), text);
        const plain = await ask(port, '/level.json', {});
        assert.equal(plain.headers['content-encoding'], undefined);
        assert.deepEqual(plain.body, text);
        const small = await ask(port, '/small.json', { 'accept-encoding': 'gzip' });
        assert.equal(small.headers['content-encoding'], undefined);
        assert.equal(small.body.toString(), '{}');
        assert.equal((await ask(port, '/../level.json', {})).status, 200); // nothing outside of the folder
        assert.equal((await ask(port, '/none.json', {})).status, 404);
    } finally {
        server.close();
        rmSync(folder, { recursive: true });
    }
});
