// The library's memory: layouts of C structs, and conversion to and from plain objects.
import { structs } from './structs.js';

const scalars = {
    f64: { size: 8, get: (v, at) => v.getFloat64(at, true), set: (v, at, x) => v.setFloat64(at, x, true) },
    f32: { size: 4, get: (v, at) => v.getFloat32(at, true), set: (v, at, x) => v.setFloat32(at, x, true) },
    i32: { size: 4, get: (v, at) => v.getInt32(at, true), set: (v, at, x) => v.setInt32(at, x, true) },
    u32: { size: 4, get: (v, at) => v.getUint32(at, true), set: (v, at, x) => v.setUint32(at, x, true) },
    u64: { size: 8, get: (v, at) => v.getBigUint64(at, true), set: (v, at, x) => v.setBigUint64(at, BigInt(x), true) },
    bool: { size: 1, get: (v, at) => v.getUint8(at) !== 0, set: (v, at, x) => v.setUint8(at, x ? 1 : 0) },
    pointer: { size: 4, get: (v, at) => v.getUint32(at, true), set: (v, at, x) => v.setUint32(at, x, true) },
};
const typedArrays = { f64: Float64Array, f32: Float32Array, i32: Int32Array, u32: Uint32Array };
const encoder = new TextEncoder();
const decoder = new TextDecoder();
const layouts = new Map();

/** Size, alignment and field offsets of a struct or a scalar, by the C ABI of wasm32. */
export function layoutOf(kind) {
    let layout = layouts.get(kind);
    if (layout !== undefined) {
        return layout;
    }
    if (kind === 'text' || kind === 'list' || kind === 'callback') {
        layout = { size: 4, align: 4 };
    } else if (scalars[kind] !== undefined) {
        layout = { size: scalars[kind].size, align: scalars[kind].size };
    } else {
        let size = 0;
        let align = 1;
        const fields = [];
        for (const [name, type, length, more] of structs[kind]) {
            const count = length || undefined;
            const one = layoutOf(type);
            size = Math.ceil(size / one.align) * one.align;
            fields.push({ name, type, count, more, offset: size, step: one.size });
            size += one.size * (count ?? 1);
            align = Math.max(align, one.align);
        }
        layout = { size: Math.ceil(size / align) * align, align, fields };
    }
    layouts.set(kind, layout);
    return layout;
}

/** True for structs that begin with struct_size: the library has their defaults. */
const grows = (kind) => structs[kind]?.[0][0] === 'struct_size';

/** True for ids, whose fields are index and generation. null stands for no body, player and so on. */
export const isId = (kind) => structs[kind]?.map(([name]) => name).join() === 'index,generation';

/** Throws a TypeError unless `value` is a number, a boolean, or for u64 a BigInt, and whole where `kind` is. */
export function requireNumber(kind, value, label) {
    if (typeof value !== 'number' && typeof value !== 'boolean' && (kind !== 'u64' || typeof value !== 'bigint')) {
        throw new TypeError(`${label}: a number is needed, not ${value}`);
    }
    if (typeof value === 'number' && (kind === 'i32' || kind === 'u32' || kind === 'u64') && !Number.isInteger(value)) {
        throw new TypeError(`${label}: a whole number is needed, not ${value}`);
    }
}

/** Scratch memory of one call, and views that stay valid when the memory grows. */
export class Memory {
    /** JavaScript functions that the library calls. */
    functions;
    #exports;
    #view;
    #begin = 0;
    #size = 0;
    #used = 0;
    #extra = [];

    constructor(exports) {
        this.#exports = exports;
        this.functions = new Functions(this, exports.__indirect_function_table);
    }

    get view() {
        if (this.#view === undefined || this.#view.buffer !== this.#exports.memory.buffer) {
            this.#view = new DataView(this.#exports.memory.buffer);
        }
        return this.#view;
    }
    bytes(at, size) {
        return new Uint8Array(this.#exports.memory.buffer, at, size);
    }

    /** Memory until release() with a mark that was taken before, zeroed. */
    take(size) {
        if (this.#begin === 0) {
            this.#size = 1 << 16;
            this.#begin = this.#allocate(this.#size);
        }
        const aligned = Math.ceil(size / 16) * 16;
        let at = this.#begin + this.#used;
        if (this.#used + aligned <= this.#size) {
            this.#used += aligned;
        } else {
            at = this.#allocate(aligned);
            this.#extra.push(at);
        }
        this.bytes(at, aligned).fill(0);
        return at;
    }
    mark() {
        return [this.#used, this.#extra.length];
    }
    release([used, extra]) {
        this.#used = used;
        for (const at of this.#extra.splice(extra)) {
            this.#exports.free(at);
        }
    }
    #allocate(size) {
        const at = this.#exports.malloc(size);
        if (at === 0) {
            throw new RangeError('no memory left for ' + size + ' bytes');
        }
        return at;
    }

    takeText(text) {
        const bytes = encoder.encode(text);
        const at = this.take(bytes.length + 1);
        this.bytes(at, bytes.length).set(bytes);
        return at;
    }
    takeBytes(bytes) {
        const at = this.take(bytes.byteLength);
        this.bytes(at, bytes.byteLength).set(new Uint8Array(bytes.buffer ?? bytes, bytes.byteOffset ?? 0, bytes.byteLength));
        return at;
    }
    text(at) {
        if (at === 0) {
            return null;
        }
        const all = new Uint8Array(this.#exports.memory.buffer);
        return decoder.decode(all.subarray(at, all.indexOf(0, at)));
    }

    read(kind, at) {
        if (scalars[kind] !== undefined) {
            return scalars[kind].get(this.view, at);
        }
        if (kind === 'text') {
            return this.text(this.view.getUint32(at, true));
        }
        const object = {};
        for (const { name, type, count, offset, step } of layoutOf(kind).fields) {
            if (name !== 'struct_size' && type !== 'list' && type !== 'callback') {
                object[name] = count === undefined ? this.read(type, at + offset)
                    : Array.from({ length: count }, (_, i) => this.read(type, at + offset + i * step));
            }
        }
        return object;
    }
    readList(kind, at, count) {
        const { size } = layoutOf(kind);
        return Array.from({ length: count }, (_, i) => this.read(kind, at + i * size));
    }

    // The view is taken after the word is known: making it may grow the memory, which detaches views.
    #setWord(at, word) {
        this.view.setUint32(at, word, true);
    }

    /** Writes the fields that the object has. Throws a TypeError for one that the struct lacks. */
    write(kind, at, value, label = kind) {
        if (scalars[kind] !== undefined) {
            requireNumber(kind, value, label);
            scalars[kind].set(this.view, at, value);
            return;
        }
        if (kind === 'text') {
            this.#setWord(at, value === null ? 0 : this.takeText(value));
            return;
        }
        const { fields, size } = layoutOf(kind);
        if (value === null && isId(kind)) {
            this.bytes(at, size).fill(0);
            return;
        }
        if (value === null || typeof value !== 'object') {
            throw new TypeError(`${kind}: an object is needed, not ${value}`);
        }
        // Vectors and rotations may be objects with more: those of three.js, for instance.
        if (kind === 'hh_vec3' || kind === 'hh_quat') {
            const missing = fields.find(({ name }) => typeof value[name] !== 'number');
            if (missing !== undefined) {
                throw new TypeError(`${kind}: "${missing.name}" must be a number, not ${value[missing.name]}`);
            }
        } else {
            for (const name of Object.keys(value)) {
                if (!fields.some((field) => field.name === name)) {
                    throw new TypeError(`${kind} has no field "${name}"`);
                }
            }
        }
        for (const { name, type, count, more, offset, step } of fields) {
            const given = value[name];
            if (given === undefined) {
                continue;
            }
            if (type === 'list') {
                if (given !== null && typeof given.length !== 'number') {
                    throw new TypeError(`${kind}.${name}: a list is needed`);
                }
                const length = given?.length ?? 0;
                if (length % more.each !== 0) {
                    throw new TypeError(`${name}: ${length} numbers are not a multiple of ${more.each}`);
                }
                this.#setWord(at + offset, this.takeList(more.of, given ?? [], `${kind}.${name}`));
                this.#setWord(at + fields.find((field) => field.name === more.count).offset, length / more.each);
            } else if (type === 'callback') {
                this.#setWord(at + offset, given === null ? 0 : this.functions.install(given, more));
            } else if (count === undefined) {
                this.write(type, at + offset, given, `${kind}.${name}`);
            } else {
                if (given?.length !== count) {
                    throw new TypeError(`${kind}.${name}: a list of ${count} is needed`);
                }
                Array.from(given).forEach((one, i) => this.write(type, at + offset + i * step, one, `${kind}.${name}`));
            }
        }
    }
    /** One struct or number until release(): the library's defaults, or else zero and no rotation, and what `given` says. */
    takeOne(kind, given) {
        const at = this.take(layoutOf(kind).size);
        this.fill(kind, at);
        if (given !== undefined) {
            this.write(kind, at, given);
        }
        return at;
    }
    takeList(kind, values, label = kind) {
        const { size } = layoutOf(kind);
        const at = this.take(size * values.length);
        const Numbers = typedArrays[kind];
        if (Numbers !== undefined) {
            const isFit = values instanceof Numbers || (ArrayBuffer.isView(values) && (kind === 'f32' || kind === 'f64'));
            for (let i = 0; !isFit && i < values.length; ++i) {
                requireNumber(kind, values[i], label);
            }
            new Numbers(this.#exports.memory.buffer, at, values.length).set(values);
            return at;
        }
        Array.from(values).forEach((value, i) => {
            this.fill(kind, at + i * size);
            this.write(kind, at + i * size, value, label);
        });
        return at;
    }
    /** Fills zeroed memory with the defaults of a struct. */
    fill(kind, at) {
        if (grows(kind)) {
            const result = this.#exports[`hh_default_${kind.slice(3)}_sized`](at, layoutOf(kind).size);
            if (result !== 0) {
                throw new Error(`no defaults of ${kind}: result ${result}`);
            }
        } else if (kind === 'hh_quat') {
            this.view.setFloat64(at + 24, 1, true);
        } else if (structs[kind] !== undefined) {
            for (const { type, count, offset, step } of layoutOf(kind).fields) {
                for (let i = 0; structs[type] !== undefined && i < (count ?? 1); ++i) {
                    this.fill(type, at + offset + i * step);
                }
            }
        }
    }
}

const wasmTypes = { f64: 0x7c, f32: 0x7d, u64: 0x7e };
const wasmType = (kind) => wasmTypes[kind] ?? 0x7f; // structs are passed by their address

// A WebAssembly function that calls `work`: a module that imports it and exports it again. (WebAssembly.Function is not in every browser.)
function wasmFunction(work, params, returns) {
    const name = (text) => [text.length, ...new TextEncoder().encode(text)];
    const section = (id, bytes) => [id, bytes.length, ...bytes];
    const type = [0x60, params.length, ...params, ...(returns === undefined ? [0] : [1, returns])];
    const bytes = [0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, ...section(1, [1, ...type]), ...section(2, [1, ...name('e'), ...name('f'), 0, 0]),
        ...section(7, [1, ...name('f'), 0, 0])];
    return new WebAssembly.Instance(new WebAssembly.Module(new Uint8Array(bytes)), { e: { f: work } }).exports.f;
}

/** JavaScript functions in the library's table. What they throw reaches the caller when the library's call has ended. */
class Functions {
    #memory;
    #table;
    #free = [];
    #installed = [];
    #error;
    /** How many functions are running: objects of the library must stay until they have ended. */
    running = 0;

    constructor(memory, table) {
        this.#memory = memory;
        this.#table = table;
    }
    install(work, { returns, params }) {
        if (typeof work !== 'function') {
            throw new TypeError('a function is needed');
        }
        const call = (...words) => {
            ++this.running;
            try {
                return this.#call(work, returns, params, words);
            } catch (error) {
                this.#error ??= { error };
                return returns === 'u64' ? 0n : 0;
            } finally {
                --this.running;
            }
        };
        const at = this.#free.pop() ?? this.#table.grow(1);
        this.#table.set(at, wasmFunction(call, params.map(([, kind]) => wasmType(kind)), returns === 'void' ? undefined : wasmType(returns)));
        this.#installed.push(at);
        return at;
    }
    #call(work, returns, params, words) {
        const m = this.#memory;
        const given = [];
        let out;
        params.forEach(([role, kind], i) => {
            const word = words[i];
            if (role === 'value') {
                given.push(structs[kind] === undefined ? word : m.read(kind, word));
            } else if (role === 'text') {
                given.push(m.text(word));
            } else if (role === 'array') {
                given.push(m.readList(kind, word, words[i + 1]));
            } else if (role === 'task') {
                given.push((index) => this.#table.get(word)(words[i + 1], index));
            } else if (role === 'out') {
                out = { kind, at: word };
            }
        });
        const answer = work(...given);
        if (returns === 'u64') {
            requireNumber(returns, answer, 'the result');
            return BigInt(answer);
        }
        if (out === undefined || answer === null || answer === undefined) {
            return Number(out === undefined && returns !== 'void' ? answer : 0);
        }
        if (typeof answer !== 'object') {
            throw new TypeError(`a query returns ${out.kind} or null`);
        }
        m.write(out.kind, out.at, answer);
        return 1;
    }
    /** The functions that were installed since the last call. */
    takeInstalled() {
        return this.#installed.splice(0);
    }
    remove(places) {
        for (const at of places) {
            this.#table.set(at, null);
            this.#free.push(at);
        }
    }
    /** Throws what a function has thrown. */
    rethrow() {
        const thrown = this.#error;
        this.#error = undefined;
        if (thrown !== undefined) {
            throw thrown.error;
        }
    }
}
