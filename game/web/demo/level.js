// A scene file of the game (docs/reference/scene_format.md) with its models: bodies for the library,
// meshes for three.js. Reads what `handhold build-station` writes: levels, free bodies, lamps, spawns.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HH_DYNAMIC } from 'handhold';

const vec = ([x, y, z]) => ({ x, y, z });
const quat = ([x, y, z, w]) => ({ x, y, z, w });
const poseOf = ({ position_m = [0, 0, 0], rotation_xyzw = [0, 0, 0, 1] }) => ({ position: vec(position_m), rotation: quat(rotation_xyzw) });
const nextFrame = () => new Promise((resolve) => setTimeout(resolve));

/** Returns {scene, names, movers, spawns}. `movers`: [{body, object}] of dynamic bodies. */
export async function loadLevel(handhold, world, url, tell) {
    const file = await (await fetch(url)).json();
    const loader = new GLTFLoader();
    const level = { scene: new THREE.Scene(), names: new Map(), movers: [], spawns: file.spawns.map((one) => ({ name: one.name, ...poseOf(one) })) };
    for (const part of file.levels) {
        tell('Loading the station', 0);
        const { scene } = await loader.loadAsync(new URL(part.file, url).href);
        level.scene.add(scene);
        await addStatics(handhold, world, level, scene, tell);
    }
    for (const body of file.bodies) {
        await addBody(world, level, body, loader, url);
    }
    addLights(level.scene, file.lamps);
    return level;
}

// Each mesh node is a static body, as in the game.
async function addStatics(handhold, world, level, scene, tell) {
    const nodes = [];
    scene.updateMatrixWorld(true);
    scene.traverse((node) => { if (node.isMesh) nodes.push(node); });
    for (const [i, node] of nodes.entries()) {
        tell('Preparing surfaces for hands', i / nodes.length);
        await nextFrame();
        const geometry = node.geometry.clone().applyMatrix4(node.matrixWorld);
        const positions = geometry.getAttribute('position').array;
        const mesh = handhold.createMesh({ positions, indices: geometry.index.array });
        const body = world.addBody({ name: `level/${i}/${node.name}`, shape: world.addMeshShape(mesh) });
        handhold.destroyMesh(mesh);
        level.names.set(body.index, node.name);
    }
}

function addShape(world, shape) {
    switch (shape.type) {
        case 'box': return world.addBox(vec(shape.half_m));
        case 'sphere': return world.addSphere(shape.radius_m);
        case 'capsule': return world.addCapsule(shape.radius_m, shape.half_height_m);
        case 'cylinder': return world.addCylinder(shape.radius_m, shape.half_height_m);
        default: throw new Error(`the demo has no shape "${shape.type}"`);
    }
}

async function addBody(world, level, body, loader, url) {
    const id = world.addBody({
        name: body.name, kind: HH_DYNAMIC, shape: addShape(world, body.shape), pose: poseOf(body), mass_kg: body.mass_kg,
        velocity_mps: vec(body.velocity_mps ?? [0, 0, 0]), angular_velocity_radps: vec(body.angular_velocity_radps ?? [0, 0, 0]),
        restitution: body.restitution ?? 0, friction: body.friction ?? 0.4,
    });
    level.names.set(id.index, body.name);
    const object = body.visual ? (await loader.loadAsync(new URL(body.visual, url).href)).scene : new THREE.Group();
    level.scene.add(object);
    level.movers.push({ body: id, object });
}

// The game's lamps are many and small; a browser gets the brightest few of them and light from all round.
function addLights(scene, lamps) {
    scene.background = new THREE.Color(0x05070a);
    scene.add(new THREE.HemisphereLight(0xdfe8ff, 0x3a3f48, 1.6));
    const sun = new THREE.DirectionalLight(0xfff4e0, 1.4);
    sun.position.set(4, 9, 6);
    scene.add(sun);
    const every = Math.ceil(lamps.length / 6);
    for (const lamp of lamps.filter((_, i) => i % every === 0)) {
        const light = new THREE.PointLight(new THREE.Color(...lamp.color), 8, lamp.reach_m);
        light.position.set(...lamp.position_m);
        scene.add(light);
    }
}

export function place(object, { position, rotation }) {
    object.position.set(position.x, position.y, position.z);
    object.quaternion.set(rotation.x, rotation.y, rotation.z, rotation.w);
}
