// Writes structs.js and structs.d.ts: the C interface's structs and enums, read from its headers. So
// the package cannot disagree with the library about a field. uint8_t are flags.
//
// usage: node make_structs.mjs INCLUDE_DIR OUT_DIR
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [includeDir, outDir] = process.argv.slice(2);
const headers = ['base.h', 'world.h', 'level.h', 'players.h'];
const text = headers.map((name) => readFileSync(join(includeDir, 'handhold', name), 'utf8')).join('\n');
const constants = new Map([...text.matchAll(/^#define (HH_\w+) (\d+)$/gm)].map((m) => [m[1], Number(m[2])]));

const typeNames = { double: 'f64', float: 'f32', int32_t: 'i32', uint32_t: 'u32', uint64_t: 'u64', size_t: 'u32', uint8_t: 'bool' };

// Enums: [name, [[constant, value], ...]].
const enums = [...text.matchAll(/typedef enum (\w+) \{([\s\S]*?)\} \1;/g)].map(([, name, body]) => {
    let next = 0;
    const values = body.replace(/\/\*[\s\S]*?\*\//g, '').split(',').map((one) => one.trim()).filter(Boolean);
    return [name, values.map((one) => {
        const [constant, value] = one.split('=').map((part) => part.trim());
        next = value === undefined ? next : Number(value);
        constants.set(constant, next);
        return [constant, next++];
    })];
});
const enumNames = new Set(enums.map(([name]) => name));

// Comments that stand behind a field.
function fieldsOf(body) {
    const fields = [];
    for (const [, declaration, comment] of body.matchAll(/([^;/]+);(?:[ \t]*\/\*([\s\S]*?)\*\/)?|\/\*[\s\S]*?\*\//g)) {
        if (declaration === undefined || declaration.includes('(')) {
            continue;
        }
        const words = declaration.trim().match(/^(?:const )?(\w+)(\*?)\s*([\s\S]*)$/);
        if (words === null) {
            throw new Error(`cannot read the field "${declaration.trim()}"`);
        }
        const [, type, pointer, names] = words;
        for (const one of names.split(',')) {
            const [, star, name, length] = one.trim().match(/^(\*?)(\w+)(?:\[(\w+)\])?$/);
            const count = length === undefined ? undefined : (constants.get(length) ?? Number(length));
            const kind = pointer || star ? (type === 'char' ? 'text' : 'pointer')
                : enumNames.has(type) ? 'i32' : (typeNames[type] ?? type);
            const pointee = kind === 'pointer' ? type : undefined;
            fields.push({ name, kind, count, pointee, comment: comment?.replace(/\s*\n\s*\*?\s*/g, ' ').trim() });
        }
    }
    return fields;
}
const structs = [...text.matchAll(/typedef struct (\w+) \{([\s\S]*?)\n\} \1;/g)]
    .map(([, name, body]) => [name, fieldsOf(body)])
    .filter(([name]) => name !== 'hh_host_hooks');

const plain = { f64: 'number', f32: 'number', i32: 'number', u32: 'number', u64: 'bigint', bool: 'boolean', text: 'string | null', pointer: 'number' };
const tsType = ({ kind, count }) => {
    const one = plain[kind] ?? kind;
    return count === undefined ? one : `${one}[]`;
};

const notice = '// Made from the C headers by make_structs.mjs; do not edit.\n';
let js = notice;
let ts = notice;
for (const [name, values] of enums) {
    for (const [constant, value] of values.filter(([one]) => !one.endsWith('_32_BITS'))) {
        js += `export const ${constant} = ${value};\n`;
        ts += `export declare const ${constant}: ${value};\n`;
    }
}
js += `export const structs = {\n`;
for (const [name, fields] of structs) {
    js += `    ${name}: [${fields.map((f) => `['${f.name}', '${f.kind}'${f.count === undefined ? '' : `, ${f.count}`}]`).join(', ')}],\n`;
    ts += `export interface ${name} {\n${fields.filter((f) => f.name !== 'struct_size')
        .map((f) => `${f.comment ? `    /** ${f.comment} */\n` : ''}    ${f.name}: ${tsType(f)};\n`).join('')}}\n`;
}
js += '};\n';
writeFileSync(join(outDir, 'structs.js'), js);
writeFileSync(join(outDir, 'structs.d.ts'), ts);
