// Compares the time of a whole step: native, in Node and in headless Chromium, by turns.
//
//     HANDHOLD_PACKAGE=FOLDER HANDHOLD_NATIVE_GRIP=PROGRAM node step_times.mjs [ROUNDS [PLAYS [MODULE]]]
//
// Each round plays the scene PLAYS times in each place (default: 3 rounds of 40 plays, 270 steps each, handhold.wasm). Engines first compile
// a module without optimising it, and replace its functions one by one while they run, so each place's first play is reported alone. Of the
// plays in the second half it reports the median and the shortest of their mean steps, over all rounds. Exit status 1: hashes differ.
//
// All times are by the clock, so other programs lengthen them. Native: hh_world_stats.step_us, the step alone. Node and Chromium: the loop
// over the steps, with samples made and converted, the call, and stats() of each step; without making the world.
import { execFileSync } from 'node:child_process';
import { join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { findChromium, inChromium } from './chromium.mjs';
import { playSameScene } from './same_scene.mjs';

const [rounds = 3, plays = 40] = process.argv.slice(2, 4).map(Number);
const module = process.argv[4] ?? 'handhold.wasm';

async function playInNode() {
    const handhold = await import(pathToFileURL(join(resolve(process.env.HANDHOLD_PACKAGE), 'handhold.js')));
    const library = await handhold.loadHandhold(pathToFileURL(join(resolve(process.env.HANDHOLD_PACKAGE), module)));
    return Array.from({ length: plays }, () => playSameScene(library, handhold));
}
if (process.argv[5] === 'node') { // a process of its own: each begins with a module that is not yet optimised
    console.log(JSON.stringify(await playInNode()));
    process.exit();
}

const chromium = findChromium();
const places = {
    native: () => execFileSync(process.env.HANDHOLD_NATIVE_GRIP, [plays], { encoding: 'utf8' }).trim().split('\n').map((line) => {
        const [, hash, mean_us] = line.match(/^(\S+) .* mean_us (\S+)$/);
        return { hash, mean_us: Number(mean_us) };
    }),
    Node: () => JSON.parse(execFileSync(process.execPath, [fileURLToPath(import.meta.url), rounds, plays, module, 'node'], { encoding: 'utf8' })),
};
if (chromium !== undefined) {
    places.Chromium = () => inChromium(chromium, `const library = await handhold.loadHandhold('/package/${module}');
        return Array.from({ length: ${plays} }, () => playSameScene(library, handhold));`);
}
const first = {}, later = {}, hashes = new Set();
for (let round = 0; round < rounds; ++round) {
    for (const [place, play] of Object.entries(places)) {
        const played = await play();
        if (played.error !== undefined) {
            throw new Error(`${place}: ${played.error}`);
        }
        played.forEach(({ hash }) => hashes.add(hash));
        (first[place] ??= []).push(played[0].mean_us);
        (later[place] ??= []).push(...played.slice(plays / 2).map((one) => one.mean_us));
    }
}
const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
for (const place of Object.keys(places)) {
    const [typical, shortest] = [median(later[place]), Math.min(...later[place])];
    console.log(`${place.padEnd(8)} first play ${median(first[place]).toFixed(0)} us, later ${typical.toFixed(0)} us, shortest ${shortest.toFixed(0)} us, ` +
        `against native ${(typical / median(later.native)).toFixed(2)} and ${(shortest / Math.min(...later.native)).toFixed(2)}`);
}
console.log(`${module}: ${hashes.size === 1 ? 'hashes are equal' : `hashes DIFFER: ${[...hashes].join(' ')}`}`);
process.exit(hashes.size === 1 ? 0 : 1);
