// Prints what tests/portability/grip_hash.c and tests/bindings/wall_hash.c print, by both modules of the npm package.
import * as handholdModule from 'handhold';
import { playSameScene } from './same_scene.mjs';
import { playWall } from './wall_scene.mjs';

for (const module of ['handhold.wasm', 'handhold-core.wasm']) {
    const handhold = await handholdModule.loadHandhold(new URL(import.meta.resolve(`handhold/${module}`)));
    const { hash, grips } = playSameScene(handhold, handholdModule);
    console.log(`${hash} grips ${grips.join(' ')}`);
    console.log(playWall(handhold, handholdModule).line);
}
