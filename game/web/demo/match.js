// Joins a match of `handhold serve` by WebSocket. Level, rules and the peer are the game's own code in match.wasm (page_match.hpp); here
// are its connection, the return after a lost one, and what is drawn. Runs in browsers and in Node.
import { loadHandhold, structs, World } from 'handhold';

const k_subprotocol = 'handhold-match';
const k_offer_within_s = 5;
const k_return_within_s = 60;
const k_return_every_s = 1;
const stages = ['connecting', 'offered', 'joining', 'playing', 'ended'];
const k_most_message_bytes = 8256; // of the server
const k_packet = 5; // NetKind: of the match; a newer one makes up for it
const k_most_waiting_bytes = 1000; // older packets that wait in the socket
const isMessage = (data) => data instanceof ArrayBuffer && data.byteLength <= k_most_message_bytes;
const now_s = () => 1e-3 * performance.now();

// Structs of page_match.hpp.
structs.PageVisual = [['body', 'hh_body'], ['vertices', 'pointer'], ['vertex_count', 'u32'], ['indices', 'pointer'], ['index_count', 'u32'],
    ['color', 'f32', 3], ['emissive', 'f32'], ['opacity', 'f32'], ['gloss', 'f32'], ['center', 'hh_vec3'], ['is_moving', 'u32']];
structs.PageLamp = [['position', 'hh_vec3'], ['color', 'f32', 3], ['reach_m', 'f32']];

const wristBits = (usesWrists = []) => usesWrists.reduce((bits, uses, side) => bits | Number(uses) << side, 0);

function openSocket(url, WebSocketType) {
    let socket;
    try {
        socket = new WebSocketType(url, k_subprotocol);
    } catch {
        throw new Error(`${url}: expected ws://HOST:PORT or wss://HOST:PORT`);
    }
    socket.binaryType = 'arraybuffer';
    return socket;
}

/** The first message of the server: what is played. */
function fetchOffer(url, WebSocketType) {
    return new Promise((resolve, reject) => {
        const socket = openSocket(url, WebSocketType);
        const end = (finish, value) => {
            clearTimeout(timer);
            socket.onmessage = socket.onclose = null;
            socket.close();
            finish(value);
        };
        const timer = setTimeout(() => end(reject, new Error('no server: no answer')), 1e3 * k_offer_within_s);
        socket.onmessage = ({ data }) => (isMessage(data) ? end(resolve, new Uint8Array(data))
            : end(reject, new Error('this is no server of matches')));
        socket.onclose = () => end(reject, new Error('no server: nobody listens there, or not to matches'));
        socket.onerror = () => {}; // onclose follows
    });
}

/** A number for `person`, which is the same when somebody returns. */
export const newPerson = () => crypto.getRandomValues(new BigUint64Array(1))[0];

/** Loads the level that the server plays and begins to join. Throws an Error with one clear line: no server, another version or level. */
export async function joinMatch(url, { token = '', person = newPerson(), module = new URL('./match.wasm', import.meta.url), WebSocketType = globalThis.WebSocket } = {}) {
    const [offer, handhold] = await Promise.all([fetchOffer(url, WebSocketType), loadHandhold(module)]);
    const { exports } = handhold;
    const why = handhold.scratch((m) => m.text(exports.page_load(m.takeBytes(offer), offer.byteLength)));
    if (why !== null) {
        throw new Error(why);
    }
    return new Match(handhold, url, token, person, WebSocketType);
}

export class Match {
    #url;
    #token;
    #socket;
    #person;
    #WebSocketType;
    #hasPlayed = false;
    #lost_s;
    #next_s = 0;

    constructor(handhold, url, token, person, WebSocketType) {
        this.handhold = handhold;
        this.world = new World(handhold, handhold.exports.page_world());
        this.scene = this.#text('page_scene');
        this.players = handhold.scratch((m) => Array.from({ length: handhold.exports.page_player_count() }, (_, slot) => {
            const at = m.takeOne('hh_player');
            handhold.exports.page_player(slot, at);
            return m.read('hh_player', at);
        }));
        this.#url = url;
        this.#token = token;
        this.#person = person;
        this.#WebSocketType = WebSocketType;
        this.#connect();
    }
    #text(name, ...words) {
        return this.handhold.memory.text(this.handhold.exports[name](...words));
    }
    #connect() {
        const { handhold } = this;
        const socket = openSocket(this.#url, this.#WebSocketType);
        this.#socket?.close();
        this.#socket = socket;
        handhold.scratch((m) => handhold.exports.page_connect(this.#person, m.takeText(this.#token), now_s()));
        socket.onmessage = ({ data }) => {
            if (!isMessage(data)) {
                socket.close();
            } else if (socket === this.#socket) {
                handhold.scratch((m) => handhold.exports.page_receive(m.takeBytes(new Uint8Array(data)), data.byteLength));
            }
        };
        socket.onclose = () => {
            if (socket === this.#socket) {
                handhold.scratch((m) => handhold.exports.page_closed(m.takeText('the connection was lost')));
            }
        };
        socket.onerror = () => {}; // onclose follows
    }
    #send() {
        const { exports, memory } = this.handhold;
        this.handhold.scratch((m) => {
            const out = m.take(4);
            for (let size = exports.page_next_message(out); size > 0; size = exports.page_next_message(out)) {
                const message = memory.bytes(memory.view.getUint32(out, true), size).slice();
                const isDropped = message[0] === k_packet && this.#socket.bufferedAmount > k_most_waiting_bytes;
                if (this.#socket.readyState === 1 && !isDropped) {
                    this.#socket.send(message);
                }
            }
        });
    }

    /** Call once a frame. Receives, steps the ticks that are due, sends, and comes back by itself after a lost connection. `sample`,
     * `commands`: of the devices, now; `usesWrists`: by side, as devices.js gives them. Returns the number of ticks. */
    poll({ sample, samples = [{ ...sample, time_s: 0 }], commands = {}, usesWrists = [false, false] }) {
        const { exports } = this.handhold;
        const ticks = this.handhold.scratch((m) => exports.page_poll(now_s(), m.takeOne('hh_match_input', { samples, commands }), wristBits(usesWrists)));
        if (ticks < 0) {
            throw new Error(this.why);
        }
        this.#send();
        if (this.stage === 'playing') {
            this.#hasPlayed = true;
            this.#lost_s = undefined;
        } else if (this.stage === 'ended') {
            this.#comeBack();
        }
        return ticks;
    }
    #comeBack() {
        const now = now_s();
        this.#lost_s ??= now;
        if (!this.isOver && now >= this.#next_s) {
            this.#next_s = now + k_return_every_s;
            this.#connect();
        } else if (this.isOver) {
            this.#socket.close();
        }
    }

    get stage() {
        return stages[this.handhold.exports.page_stage()];
    }
    /** Why it has ended, or waits for the server. */
    get why() {
        return this.#text('page_why').replace(' (--token)', '');
    }
    /** True once nothing brings the player back: `why` says the reason. */
    get isOver() {
        return this.stage === 'ended' && (!this.#hasPlayed || this.handhold.exports.page_may_return() === 0
            || (this.#lost_s !== undefined && now_s() - this.#lost_s > k_return_within_s));
    }
    /** True while the connection is lost and the player may come back. */
    get isLost() {
        return this.#lost_s !== undefined && !this.isOver;
    }
    get slot() {
        return this.handhold.exports.page_slot();
    }
    get player() {
        return this.players[this.slot];
    }
    /** States that the server has sent. */
    get states() {
        return this.handhold.exports.page_states();
    }
    /** "blue 2 : 1 orange"; "" where nobody counts. */
    get score() {
        return this.#text('page_score');
    }
    /** hh_match_stats; null before the first state. */
    stats() {
        const match = this.handhold.exports.page_match();
        return match === 0 ? null : this.handhold.scratch((m) => {
            const at = m.takeOne('hh_match_stats');
            this.handhold.check(this.handhold.exports.hh_match_get_stats(match, at));
            return m.read('hh_match_stats', at);
        });
    }
    /** Hash of a confirmed tick, 0x and 16 digits; null for one that is too old. */
    hash(tick) {
        return this.handhold.scratch((m) => {
            const at = m.take(8);
            const result = this.handhold.exports.hh_match_hash(this.handhold.exports.page_match(), BigInt(tick), at);
            return result === 0 ? `0x${m.view.getBigUint64(at, true).toString(16).padStart(16, '0')}` : null;
        });
    }
    /** Where to draw a slot's player between two ticks, at the time of the last poll: `origin`, `head` and `hands`, as of hh_match_drawn_player.
     * `newest`: `sample` and `usesWrists` of the own devices now, as for poll. Null before the first tick that is shown. */
    drawnPlayer(slot, newest = null) {
        const { exports } = this.handhold;
        return exports.page_match() === 0 ? null : this.handhold.scratch((m) => {
            const sample = newest === null ? 0 : m.takeOne('hh_tracking_sample', newest.sample);
            const out = Array.from({ length: 4 }, () => m.takeOne('hh_pose'));
            if (exports.page_drawn_player(slot, sample, wristBits(newest?.usesWrists), ...out) !== 0) {
                return null;
            }
            const [origin, head, left, right] = out.map((at) => m.read('hh_pose', at));
            return { origin, head, hands: [left, right] };
        });
    }
    /** Poses of bodies, likewise. */
    drawnBodies(bodies) {
        const { exports } = this.handhold;
        const match = exports.page_match();
        return match === 0 ? null : this.handhold.scratch((m) => {
            const out = m.takeList('hh_pose', bodies.map(() => ({})));
            const result = exports.hh_match_drawn_bodies(match, m.takeList('hh_body', bodies), bodies.length, out);
            return result === 0 ? m.readList('hh_pose', out, bodies.length) : null;
        });
    }
    /** PageVisual of what is drawn, with `vertices` and `indices` as arrays. */
    visuals() {
        const { memory } = this.handhold;
        const buffer = () => memory.view.buffer;
        return this.#list('PageVisual', 'page_visuals').map((one) => ({
            ...one,
            vertices: new Float32Array(buffer(), one.vertices, 6 * one.vertex_count).slice(),
            indices: new Uint32Array(buffer(), one.indices, one.index_count).slice(),
        }));
    }
    lamps() {
        return this.#list('PageLamp', 'page_lamps');
    }
    bodyName(body) {
        return this.handhold.scratch((m) => this.#text('page_body_name', m.takeOne('hh_body', body)));
    }
    #list(kind, name) {
        return this.handhold.scratch((m) => {
            const out = m.take(4);
            const count = this.handhold.exports[name](out);
            return m.readList(kind, m.view.getUint32(out, true), count);
        });
    }
    leave() {
        this.handhold.exports.page_leave();
        this.#send();
        this.#socket.close();
    }
}
