// Handhold in a browser: the game's station, with mouse and keyboard or a headset. window.demo is for tests.
import * as THREE from 'three';
import { HH_LEFT, HH_RIGHT, loadHandhold } from 'handhold';
import { Avatar } from './avatar.js';
import { Desktop, Headset } from './devices.js';
import { loadLevel, place } from './level.js';
import { Panel } from './panel.js';

const element = (id) => document.getElementById(id);
function tell(stage, share) {
    element('stage').textContent = stage;
    document.querySelector('progress').value = share;
}

const handhold = await loadHandhold();
const world = handhold.createWorld();
world.setTuning('locomotion.thruster_mps2', 1.5);
const level = await loadLevel(handhold, world, new URL('station/station.json', location.href), tell);
const spawnName = new URLSearchParams(location.search).get('spawn');
const spawn = level.spawns.find((one) => one.name === spawnName) ?? level.spawns[0];
const player = world.addPlayer({ name: 'you', origin: { position: spawn.position, rotation: spawn.rotation } });

const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.xr.enabled = true;
renderer.xr.setReferenceSpaceType('local-floor');
document.body.prepend(renderer.domElement);
const camera = new THREE.PerspectiveCamera(75, 1, 0.03, 200);
const rig = new THREE.Group(); // the play space
rig.add(camera);
level.scene.add(rig);
const vignette = makeVignette();
camera.add(vignette);
const avatar = new Avatar(level.scene);
const desktop = new Desktop(renderer.domElement);
const headset = new Headset();
const panel = new Panel(level.names);

function makeVignette() {
    const ring = new THREE.Mesh(new THREE.RingGeometry(0.11, 1, 48),
        new THREE.MeshBasicMaterial({ color: 0x000000, transparent: true, opacity: 0, depthTest: false }));
    ring.position.z = -0.2;
    ring.renderOrder = 10;
    return ring;
}
function resize() {
    camera.aspect = innerWidth / innerHeight;
    camera.updateProjectionMatrix();
    renderer.setSize(innerWidth, innerHeight);
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
}
addEventListener('resize', resize);
resize();

// Wrists or controllers: the library is told when that changes.
let usedWrists;
function chooseHands(usesWrists) {
    if (usesWrists !== usedWrists) {
        usedWrists = usesWrists;
        for (const side of [HH_LEFT, HH_RIGHT]) {
            world.setHandInController(player, side, usesWrists ? {} : null);
        }
    }
}

let last_ms;
function onFrame(now_ms, frame) {
    const dt_s = Math.min(Math.max(1e-3 * (now_ms - (last_ms ?? now_ms - 14)), 1 / 250), 1 / 20);
    last_ms = now_ms;
    const space = renderer.xr.getReferenceSpace();
    const inHeadset = renderer.xr.isPresenting && frame !== undefined && frame !== null && space !== null;
    const { usesWrists, sample, commands } = inHeadset ? headset.read(frame, space) : desktop.read(dt_s);
    chooseHands(usesWrists);
    world.step(dt_s, [{ player, samples: [{ ...sample, time_s: world.time().time_s + dt_s }], commands }]);

    const pose = world.playerPose(player);
    place(rig, pose.origin);
    if (!inHeadset) {
        place(camera, sample.head);
    }
    world.bodyPoses(level.movers.map((one) => one.body)).forEach((at, i) => place(level.movers[i].object, at));
    avatar.update(world, player, pose, element('gizmos').checked);
    const v = pose.velocity_mps;
    const speed_mps = Math.hypot(v.x, v.y, v.z);
    const target = element('vignette').checked ? THREE.MathUtils.clamp((speed_mps - 1) / 2, 0, 0.9) : 0;
    vignette.material.opacity += (target - vignette.material.opacity) * Math.min(1, 6 * dt_s);
    vignette.visible = vignette.material.opacity > 0.01;
    panel.update(world, pose, speed_mps);
    renderer.render(level.scene, camera);
}

async function offerHeadset() {
    const button = element('enter');
    if (!await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false)) {
        return;
    }
    button.disabled = false;
    button.textContent = 'Enter the headset';
    button.addEventListener('click', async () => {
        const session = await navigator.xr.requestSession('immersive-vr', { requiredFeatures: ['local-floor'], optionalFeatures: ['hand-tracking'] });
        session.addEventListener('end', () => { last_ms = undefined; });
        last_ms = undefined;
        await renderer.xr.setSession(session);
    });
}

element('loading').remove();
element('panel').hidden = false;
element('help').hidden = false;
renderer.setAnimationLoop(onFrame);
await offerHeadset();
window.demo = { handhold, world, player, desktop, level, panel, renderer };
