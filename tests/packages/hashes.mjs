// Prints what tests/portability/grip_hash.c and tests/bindings/wall_hash.c print, by the npm package.
import * as handholdModule from 'handhold';
import { playSameScene } from './same_scene.mjs';
import { playWall } from './wall_scene.mjs';

const handhold = await handholdModule.loadHandhold();
const { hash, grips } = playSameScene(handhold, handholdModule);
console.log(`${hash} grips ${grips.join(' ')}`);
console.log(playWall(handhold, handholdModule).line);
