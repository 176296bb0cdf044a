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
const encoder = new TextEncoder();
const decoder = new TextDecoder();
const layouts = new Map();

/** Size, alignment and field offsets of a struct or a scalar, by the C ABI of wasm32. */
export function layoutOf(kind) {
    let layout = layouts.get(kind);
    if (layout !== undefined) {
        return layout;
    }
    if (kind === 'text') {
        layout = { size: 4, align: 4 };
    } else if (scalars[kind] !== undefined) {
        layout = { size: scalars[kind].size, align: scalars[kind].size };
    } else {
        let size = 0;
        let align = 1;
        const fields = [];
        for (const [name, type, count] of structs[kind]) {
            const one = layoutOf(type);
            size = Math.ceil(size / one.align) * one.align;
            fields.push({ name, type, count, offset: size, step: one.size });
            size += one.size * (count ?? 1);
            align = Math.max(align, one.align);
        }
        layout = { size: Math.ceil(size / align) * align, align, fields };
    }
    layouts.set(kind, layout);
    return layout;
}

/** Scratch memory of one call, and views that stay valid when the memory grows. */
export class Memory {
    #exports;
    #view;
    #begin = 0;
    #size = 0;
    #used = 0;
    #extra = [];

    constructor(exports) {
        this.#exports = exports;
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

    /** Memory until the next release(), zeroed. */
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
    release() {
        this.#used = 0;
        for (const at of this.#extra.splice(0)) {
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
            if (name !== 'struct_size') {
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

    /** Writes the fields that the object has. Throws a TypeError for one that the struct lacks. */
    write(kind, at, value) {
        if (scalars[kind] !== undefined) {
            scalars[kind].set(this.view, at, value);
            return;
        }
        if (kind === 'text') {
            const text = value === null ? 0 : this.takeText(value);
            this.view.setUint32(at, text, true);
            return;
        }
        const { fields } = layoutOf(kind);
        // Vectors and rotations may be objects with more: those of three.js, for instance.
        if (kind !== 'hh_vec3' && kind !== 'hh_quat') {
            for (const name of Object.keys(value)) {
                if (!fields.some((field) => field.name === name)) {
                    throw new TypeError(`${kind} has no field "${name}"`);
                }
            }
        }
        for (const { name, type, count, offset, step } of fields) {
            const given = value[name];
            if (given === undefined) {
                continue;
            }
            if (count === undefined) {
                this.write(type, at + offset, given);
            } else {
                given.slice(0, count).forEach((one, i) => this.write(type, at + offset + i * step, one));
            }
        }
    }
    takeList(kind, values) {
        const { size } = layoutOf(kind);
        const at = this.take(size * values.length);
        values.forEach((value, i) => this.write(kind, at + i * size, value));
        return at;
    }
}
