// What match.js does with its socket, without a network and without the game: `node --test`.
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

// match.js, where the package 'handhold' is nearly empty.
const folder = mkdtempSync(join(tmpdir(), 'handhold-socket-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
const library = join(folder, 'node_modules', 'handhold');
mkdirSync(library, { recursive: true });
writeFileSync(join(library, 'package.json'), '{ "type": "module", "exports": "./index.js" }');
writeFileSync(join(library, 'index.js'), 'export const structs = {}; export class World {} export const loadHandhold = async () => ({});');
copyFileSync(new URL('../demo/match.js', import.meta.url), join(folder, 'match.mjs'));
const { joinMatch, Match } = await import(pathToFileURL(join(folder, 'match.mjs')));

class Socket {
    static last;
    readyState = 1;
    bufferedAmount = 0;
    isClosed = false;
    sent = [];
    constructor() {
        Socket.last = this;
    }
    send(message) {
        this.sent.push([...message]);
    }
    close() {
        this.isClosed = true;
    }
}

// Stands for the game's module: keeps the sizes of received messages, and has `outgoing` to send.
function standIn(outgoing = []) {
    const received = [];
    const memory = { text: () => '', view: new DataView(new ArrayBuffer(16)), bytes: () => memory.next, takeBytes: () => 0, takeText: () => 0, takeOne: () => 0, take: () => 0 };
    const exports = {
        page_world: () => 0, page_scene: () => 0, page_player_count: () => 0, page_connect: () => {}, page_closed: () => {}, page_leave: () => {},
        page_receive: (_, size) => received.push(size),
        page_next_message: () => {
            memory.next = Uint8Array.from(outgoing.shift() ?? []);
            return memory.next.length;
        },
    };
    return { received, handhold: { memory, exports, scratch: (use) => use(memory) } };
}

const notMessages = ['500000000', new ArrayBuffer(8257), undefined];

test('a server whose first message is text or too long is none', async () => {
    for (const data of notMessages) {
        const joining = joinMatch('ws://127.0.0.1:1', { module: null, WebSocketType: Socket });
        const socket = Socket.last;
        socket.onmessage({ data });
        await assert.rejects(joining, /^Error: this is no server of matches$/);
        assert.ok(socket.isClosed);
    }
});

test('text and messages that are too long end the connection', () => {
    for (const data of notMessages) {
        const { received, handhold } = standIn();
        new Match(handhold, 'ws://127.0.0.1:1', '', 1n, Socket);
        Socket.last.onmessage({ data: new ArrayBuffer(8256) });
        assert.deepEqual(received, [8256]);
        assert.ok(!Socket.last.isClosed);
        Socket.last.onmessage({ data });
        assert.deepEqual(received, [8256]);
        assert.ok(Socket.last.isClosed);
    }
});

test('packets of the match are dropped while the socket does not send; all else is kept', () => {
    for (const [bufferedAmount, kept] of [[0, [[5, 1], [4, 2]]], [2000, [[4, 2]]]]) {
        const { handhold } = standIn([[5, 1], [4, 2]]);
        const match = new Match(handhold, 'ws://127.0.0.1:1', '', 1n, Socket);
        Socket.last.bufferedAmount = bufferedAmount;
        match.leave();
        assert.deepEqual(Socket.last.sent, kept);
    }
});
