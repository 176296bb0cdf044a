// Calls of the C interface by the table that its headers gave (calls.js).
import { calls } from './calls.js';
import { layoutOf, requireNumber } from './memory.js';
import { structs } from './structs.js';

/** Gives a class all functions that belong to a handle, or to none. Its objects have `library` and, for a handle, `handle`. */
export function addCalls(type, handle) {
    for (const [name, call] of Object.entries(calls)) {
        if (call.of === handle) {
            type.prototype[call.method] = function (...given) {
                return invoke(this, name, call, given);
            };
        }
    }
    type.prototype.setFunctions = function (name, places) {
        this.functions ??= new Map();
        const old = name === '' ? [...this.functions.values()].flat() : this.functions.get(name) ?? [];
        if (name === '') {
            this.functions.clear();
        } else {
            this.functions.set(name, places);
        }
        this.library.memory.functions.remove(old);
    };
}

function numberOf(kind, label, value) {
    requireNumber(kind, value, label);
    return kind === 'u64' ? BigInt(value) : Number(value);
}

function structOf(m, kind, label, value) {
    if (value === undefined) {
        throw new TypeError(`${label}: a ${kind} is needed`);
    }
    return m.takeOne(kind, value);
}

const isStruct = (kind) => structs[kind] !== undefined;

function invoke(object, name, { returns, params }, given) {
    const { library } = object;
    library.refuseMissing(name);
    return library.scratch((m) => {
        const words = [];
        const results = [];
        let list;
        let functions;
        let counted = 0;
        let counter = 0;
        const next = () => given.shift();
        for (const [role, kind, label, source] of params) {
            const prepare = {
                self: () => object.handle,
                value: () => {
                    const value = next();
                    return isStruct(kind) ? structOf(m, kind, label, value) : numberOf(kind, label, value);
                },
                handle: () => library.liveMesh(next() ?? 0),
                text: () => textOrNull(m, next()),
                bytes: () => bytesOrNull(m, next(), (size) => { counted = size; }),
                array: () => {
                    const values = next() ?? [];
                    if (typeof values.length !== 'number' || typeof values === 'string') {
                        throw new TypeError(`${label}: a list is needed`);
                    }
                    if (source !== undefined && values.length !== source) {
                        throw new TypeError(`${label}: ${source} elements are needed, ${values.length} are given`);
                    }
                    counted = values.length;
                    return values.length === 0 ? 0 : m.takeList(kind, values, label);
                },
                in_place: () => {
                    const values = next() ?? [];
                    const size = counted = values.length;
                    const at = m.takeList(kind, values, label);
                    results.push([label, () => m.readList(kind, at, size)]);
                    return at;
                },
                optional: () => {
                    // A definition that is left out has the library's defaults.
                    const isDefault = given.length === 0 && kind.endsWith('_def');
                    const value = isDefault ? {} : next() ?? null;
                    functions = structs[kind].some(([, type]) => type === 'callback') ? kind : functions;
                    return value === null ? 0 : m.takeOne(kind, value);
                },
                required: () => m.takeOne(kind, next()),
                count: () => counted,
                own_count: () => counted,
                out: () => output(m, results, kind, label),
                in_out: () => {
                    const at = m.takeOne(kind);
                    results.push([label, () => m.read(kind, at)]);
                    return at;
                },
                out_text: () => output(m, results, 'text', label),
                out_array: () => {
                    const size = typeof source === 'number' ? source : params.some(([one]) => one === 'own_count') ? next() : counted;
                    counted = size;
                    const at = m.take(size * layoutOf(kind).size);
                    results.push([label, () => m.readList(kind, at, size)]);
                    return at;
                },
                out_list: () => { list = { kind, label, at: words.length }; return 0; },
                out_bytes: () => { list = { kind: '', label, at: words.length }; return 0; },
                capacity: () => 0,
                count_out: () => { counter = m.take(4); return counter; },
                out_view: () => {
                    const at = m.take(4);
                    results.push([label, () => m.readList(kind, m.view.getUint32(at, true), m.view.getUint32(counter, true))]);
                    return at;
                },
                struct_size: () => layoutOf(kind).size,
            }[role];
            words.push(prepare());
        }
        if (isStruct(returns)) {
            words.unshift(m.take(layoutOf(returns).size));
        }
        const call = () => {
            const answer = library.exports[name](...words);
            m.functions.rethrow();
            if (returns === 'result') {
                library.check(answer);
            }
            return answer;
        };
        const places = functions === undefined ? [] : m.functions.takeInstalled();
        let answer;
        try {
            answer = call();
        } catch (error) {
            m.functions.remove(places);
            throw error;
        }
        if (functions !== undefined) {
            object.setFunctions(functions, places);
        }
        if (list !== undefined) {
            const room = m.view.getUint32(counter, true);
            const at = m.take(room * (list.kind === '' ? 1 : layoutOf(list.kind).size));
            words[list.at] = at;
            words[list.at + 1] = room;
            call();
            const count = m.view.getUint32(counter, true); // packets are shorter than the room that they ask for
            results.unshift([list.label, () => list.kind === '' ? m.bytes(at, count).slice() : m.readList(list.kind, at, count)]);
        }
        if (results.length === 1) {
            return results[0][1]();
        }
        if (results.length > 1) {
            return Object.fromEntries(results.map(([label, read]) => [label, read()]));
        }
        return isStruct(returns) ? m.read(returns, words[0]) : returns === 'text' ? m.text(answer) : returns === 'bool' ? answer !== 0
            : returns === 'result' || returns === 'void' ? undefined : answer;
    });
}

function output(m, results, kind, label) {
    const at = m.take(Math.max(layoutOf(kind).size, 8));
    results.push([label, () => m.read(kind, at)]);
    return at;
}
function textOrNull(m, text) {
    return text === null || text === undefined ? 0 : m.takeText(text);
}
function bytesOrNull(m, bytes, count) {
    const made = typeof bytes === 'string' ? new TextEncoder().encode(bytes) : bytes;
    if (made !== null && made !== undefined && typeof made.byteLength !== 'number') {
        throw new TypeError('a Uint8Array is needed');
    }
    count(made?.byteLength ?? 0);
    return made === null || made === undefined ? 0 : m.takeBytes(made);
}
