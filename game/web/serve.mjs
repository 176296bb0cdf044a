// Serves a folder of static files on the loopback; a file with a .gz beside it is sent compressed. usage: node serve.mjs FOLDER PORT (0: any)
import { createReadStream, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, resolve, sep } from 'node:path';
import { fileURLToPath } from 'node:url';

const types = {
    '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.json': 'application/json',
    '.glb': 'model/gltf-binary',
};

/** Resolves with the server, which listens on 127.0.0.1. */
export function serveFolder(folder, port) {
    const root = resolve(folder);
    const server = createServer((request, response) => {
        const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
        const file = join(root, path.endsWith(sep) ? path + 'index.html' : path);
        if (!file.startsWith(root + sep) || !statSync(file, { throwIfNoEntry: false })?.isFile()) {
            response.writeHead(404).end();
            return;
        }
        response.setHeader('content-type', types[extname(file)] ?? 'application/octet-stream');
        const packed = /\bgzip\b/.test(request.headers['accept-encoding'] ?? '') && statSync(`${file}.gz`, { throwIfNoEntry: false })?.isFile();
        response.setHeader('vary', 'accept-encoding');
        if (packed) {
            response.setHeader('content-encoding', 'gzip');
        }
        createReadStream(packed ? `${file}.gz` : file).pipe(response);
    });
    return new Promise((resolve) => server.listen(port, '127.0.0.1', () => resolve(server)));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    const server = await serveFolder(process.argv[2], Number(process.argv[3]));
    console.log(`http://127.0.0.1:${server.address().port}/`);
}
