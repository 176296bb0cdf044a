// A scene file of the game (docs/reference/scene_format.md) with its models: bodies for the library, in the
// native game's order and by its names, and meshes for three.js. Reads what the station and the playground
// use: levels, static and free bodies, joints, chains, lamps, spawns.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HH_BALL, HH_DYNAMIC, HH_HINGE, HH_SLIDER, HH_STATIC } from 'handhold';

const vec = ([x, y, z]) => ({ x, y, z });
// Of unit length, with the roundings of the native game, which multiplies a body's pose by two others.
const quat = (xyzw) => {
    const [x, y, z, w] = unit(unit(xyzw));
    return { x, y, z, w };
};
function unit([x, y, z, w]) {
    const length = Math.sqrt((x * x + y * y) + (z * z + w * w));
    return [x / length, y / length, z / length, w / length];
}
const poseOf = ({ position_m = [0, 0, 0], rotation_xyzw = [0, 0, 0, 1] }) => ({ position: vec(position_m), rotation: quat(rotation_xyzw) });
const rotationTo = (from, to) => new THREE.Quaternion().setFromUnitVectors(from, to.normalize()).toArray();
const nextFrame = () => new Promise((resolve) => setTimeout(resolve));

/** Returns {scene, names, movers, spawns}. `movers`: [{body, object}] of dynamic bodies. */
export async function loadLevel(handhold, world, url, tell) {
    const file = await (await fetch(url)).json();
    const loader = new GLTFLoader();
    const level = { scene: new THREE.Scene(), names: new Map(), movers: [], spawns: file.spawns.map((one) => ({ name: one.name, ...poseOf(one) })) };
    for (const part of file.levels ?? []) {
        tell('Loading the station', 0);
        const { scene } = await loader.loadAsync(new URL(part.file, url).href);
        level.scene.add(scene);
        await addStatics(handhold, world, level, part.file.replace(/^.*\/|\.\w+$/g, ''), scene, tell);
    }
    const bodies = new Map();
    for (const body of file.bodies) {
        bodies.set(body.name, await addBody(world, level, body, loader, url));
    }
    const joints = new Map();
    for (const joint of file.joints ?? []) {
        joints.set(joint.name, addJoint(world, joint, bodies, joints));
    }
    for (const chain of file.chains ?? []) {
        await addChain(world, level, chain, bodies);
    }
    addLights(level.scene, file.lamps ?? []);
    return level;
}

// Each mesh node is a static body, as in the game.
async function addStatics(handhold, world, level, stem, scene, tell) {
    const nodes = [];
    scene.updateMatrixWorld(true);
    scene.traverse((node) => { if (node.isMesh) nodes.push(node); });
    for (const [i, node] of nodes.entries()) {
        tell('Preparing surfaces for hands', i / nodes.length);
        await nextFrame();
        const geometry = node.geometry.clone().applyMatrix4(node.matrixWorld);
        const positions = geometry.getAttribute('position').array;
        const mesh = handhold.createMesh({ positions, indices: geometry.index.array });
        const name = node.userData.name ?? node.name; // without three.js's own spelling
        const body = world.addBody({ name: `${stem}/${i}/${name}`, shape: world.addMeshShape(mesh) });
        handhold.destroyMesh(mesh);
        level.names.set(body.index, name);
    }
}

/** The level of a match (match.js), as loadLevel gives one. */
export function levelOfMatch(match) {
    const level = { scene: new THREE.Scene(), names: new Map(), movers: [], spawns: [{ name: '', position: vec([0, 0, 0]), rotation: quat([0, 0, 0, 1]) }] };
    for (const visual of match.visuals()) {
        const object = matchObject(visual);
        level.names.set(visual.body.index, match.bodyName(visual.body));
        level.scene.add(object);
        if (visual.is_moving !== 0) {
            level.movers.push({ body: visual.body, object });
        } else {
            place(object, match.world.bodyPose(visual.body));
        }
    }
    addLights(level.scene, match.lamps().map(({ position, ...lamp }) => ({ ...lamp, position_m: [position.x, position.y, position.z] })));
    return level;
}
function matchObject({ vertices, indices, color, emissive, opacity, gloss, center }) {
    const geometry = new THREE.BufferGeometry();
    const buffer = new THREE.InterleavedBuffer(vertices, 6);
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(buffer, 3, 0));
    geometry.setAttribute('normal', new THREE.InterleavedBufferAttribute(buffer, 3, 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    const paint = new THREE.Color(...color); // linear, as three.js computes
    const material = new THREE.MeshStandardMaterial({ color: paint, emissive: paint, emissiveIntensity: emissive, roughness: 1 - 0.7 * gloss,
        transparent: opacity < 1, opacity, side: THREE.DoubleSide });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.set(center.x, center.y, center.z);
    return new THREE.Group().add(mesh);
}

function addShape(world, shape) {
    switch (shape.type) {
        case 'box': return world.addBox(vec(shape.half_m));
        case 'sphere': return world.addSphere(shape.radius_m);
        case 'capsule': return world.addCapsule(shape.radius_m, shape.half_height_m);
        case 'cylinder': return world.addCylinder(shape.radius_m, shape.half_height_m);
        case 'compound': return world.addCompound(shape.children.map((child) => ({
            shape: addShape(world, child.shape), pose: poseOf(child), mass_kg: child.mass_kg ?? 0 })));
        default: throw new Error(`the demo has no shape "${shape.type}"`);
    }
}

// What is drawn for a body without a model.
function shapeObject(shape, material) {
    const mesh = (geometry) => new THREE.Mesh(geometry, material);
    switch (shape.type) {
        case 'box': return mesh(new THREE.BoxGeometry(...shape.half_m.map((half_m) => 2 * half_m)));
        case 'sphere': return mesh(new THREE.SphereGeometry(shape.radius_m, 24, 16));
        case 'capsule': return mesh(new THREE.CapsuleGeometry(shape.radius_m, 2 * shape.half_height_m, 6, 16));
        case 'cylinder': return mesh(new THREE.CylinderGeometry(shape.radius_m, shape.radius_m, 2 * shape.half_height_m, 24));
        default: {
            const group = new THREE.Group();
            for (const child of shape.children) {
                const object = shapeObject(child.shape, material);
                place(object, poseOf(child));
                group.add(object);
            }
            return group;
        }
    }
}

async function addBody(world, level, body, loader, url) {
    const isFree = body.kind === 'free';
    const id = world.addBody({
        name: body.name, kind: isFree ? HH_DYNAMIC : HH_STATIC, shape: addShape(world, body.shape), pose: poseOf(body), mass_kg: body.mass_kg ?? 1,
        inertia_kgm2: vec(body.inertia_kgm2 ?? [0, 0, 0]),
        velocity_mps: vec(body.velocity_mps ?? [0, 0, 0]), angular_velocity_radps: vec(body.angular_velocity_radps ?? [0, 0, 0]),
        restitution: body.restitution ?? 0, friction: body.friction ?? 0.4,
    });
    level.names.set(id.index, body.name);
    const material = new THREE.MeshStandardMaterial({ color: new THREE.Color(...(body.color ?? [0.5, 0.5, 0.5])), roughness: 0.7 });
    const object = body.visual ? (await loader.loadAsync(new URL(body.visual, url).href)).scene : shapeObject(body.shape, material);
    place(object, poseOf(body));
    level.scene.add(object);
    if (isFree) {
        level.movers.push({ body: id, object });
    }
    return id;
}

function addJoint(world, joint, bodies, joints) {
    const isAngle = joint.type !== 'slider';
    const si = (number = 0) => (isAngle ? THREE.MathUtils.degToRad(number) : number);
    const [unit, force] = isAngle ? ['_deg', '_nm'] : ['_m', '_n'];
    const [lower, upper] = joint['limits' + unit] ?? [];
    const { latch, detent } = joint;
    const rotation_xyzw = joint.rotation_xyzw ?? rotationTo(new THREE.Vector3(1, 0, 0), new THREE.Vector3(...(joint.axis ?? [1, 0, 0])));
    return world.addJoint({
        name: joint.name, kind: { ball: HH_BALL, hinge: HH_HINGE, slider: HH_SLIDER }[joint.type],
        body_a: bodies.get(joint.a), body_b: bodies.get(joint.b), frame: poseOf({ ...joint, rotation_xyzw }),
        limited: lower !== undefined, lower: si(lower), upper: si(upper), friction: joint['friction' + force] ?? 0,
        detent_spacing: si(detent?.['spacing' + unit]), detent_strength: detent?.['strength' + force] ?? 0,
        latch_at: si(latch?.['at' + unit]), latch_range: si(latch?.['catch' + unit]), latch_strength: latch?.['strength' + force] ?? 0,
        latch_handle: joints.get(latch?.handle), latch_handle_at: latch?.handle_m ?? THREE.MathUtils.degToRad(latch?.handle_deg ?? 0),
    });
}

// Capsules in a row with ball joints between them.
async function addChain(world, level, chain, bodies) {
    const from = new THREE.Vector3(...chain.from_m);
    const way = new THREE.Vector3(...chain.to_m).sub(from);
    const at = (links) => way.clone().multiplyScalar(links / chain.links).add(from).toArray();
    const shape = { type: 'capsule', radius_m: chain.radius_m, half_height_m: 0.5 * way.length() / chain.links - chain.radius_m };
    const rotation_xyzw = rotationTo(new THREE.Vector3(0, 1, 0), way.clone());
    let a = chain.a;
    const tie = (i, b) => {
        addJoint(world, { name: `${chain.name}/joint/${i}`, type: 'ball', a, b, position_m: at(i), friction_nm: chain.friction_nm }, bodies, new Map());
        a = b;
    };
    for (let i = 0; i < chain.links; ++i) {
        const name = `${chain.name}/${i}`;
        const link = { name, kind: 'free', shape, position_m: at(i + 0.5), rotation_xyzw, mass_kg: chain.mass_kg / chain.links, color: chain.color };
        bodies.set(name, await addBody(world, level, link));
        tie(i, name);
    }
    if (chain.b !== undefined) {
        tie(chain.links, chain.b);
    }
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

/** Moves a spawn so that the player begins with a rail of the station, or a handle of the playground, within reach in front. */
export function startBeforeSomethingToGrip(spawn, sceneName) {
    if (sceneName === 'station') {
        spawn.position.x += 0.45;
        spawn.position.y -= 0.6;
        spawn.rotation = { x: 0, y: -Math.SQRT1_2, z: 0, w: Math.SQRT1_2 }; // to the rail at the side
    } else {
        spawn.position.z += 0.2;
    }
}

export function place(object, { position, rotation }) {
    object.position.set(position.x, position.y, position.z);
    object.quaternion.set(rotation.x, rotation.y, rotation.z, rotation.w);
}
