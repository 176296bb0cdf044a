// Handhold in a browser: the game's scenes, with mouse and keyboard or a headset. window.demo is for tests.
//
// ?scene=station|playground  ?spawn=NAME
// ?recording=FILE            plays a recorded session at 90 Hz instead, as `handhold run --input FILE` does: with equal path.
//                            Equal hashes need sample times that are not at frame ends (the library takes one up to
//                            1e-6 s after an end for that end), and &seconds=S beyond the last sample, which is state.
// ?join=ws://HOST:PORT       joins the match of `handhold serve` there; &token=... where it wants one
import * as THREE from 'three';
import { HH_LEFT, HH_RIGHT, loadHandhold } from 'handhold';
import { Avatar, loadFigure } from './avatar.js';
import { Desktop, FirstHint, Headset } from './devices.js';
import { levelOfMatch, loadLevel, place, startBeforeSomethingToGrip } from './level.js';
import { joinMatch, newPerson } from './match.js';
import { Panel } from './panel.js';
import { parseRecording, Playback } from './playback.js';

const element = (id) => document.getElementById(id);
function tell(stage, share) {
    element('stage').textContent = stage;
    document.querySelector('progress').value = share;
}

const query = new URLSearchParams(location.search);
const sceneName = query.get('scene') === 'playground' ? 'playground' : 'station';
const folder = new URL(`${sceneName}/`, location.href);
const loadRecording = async (url) => parseRecording(await (await fetch(url)).text());

const match = query.has('join') ? await enterMatch() : null;
const handhold = match?.handhold ?? await loadHandhold();
const world = match?.world ?? handhold.createWorld();
if (!match) {
    world.loadBodyClips(await (await fetch('body_clips.json')).text());
}
const level = match ? levelOfMatch(match) : await loadLevel(handhold, world, new URL('scene.json', folder), tell);
const recording = !match && query.has('recording') ? await loadRecording(new URL(query.get('recording'), location.href)) : null;
const recorded = recording && new Playback(recording);
// Recordings and the climber begin at the first spawn, you beside it.
const spawnName = query.get('spawn') ?? (recorded ? '' : { station: 'hab', playground: 'locker' }[sceneName]);
const spawn = level.spawns.find((one) => one.name === spawnName) ?? level.spawns[0];
if (!recorded && !match && !query.has('spawn')) {
    startBeforeSomethingToGrip(spawn, sceneName);
}
if (!recorded && !match) {
    world.setTuning('locomotion.thruster_mps2', 1.5);
}
const startOf = ({ position, rotation }) => ({ position, rotation });
const player = match?.player ?? world.addPlayer({ name: 'player0', origin: startOf(spawn) });
const climber = recorded || match ? null : await addClimber();

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
const colorOf = (slot) => (match.score === '' ? 0x37506e : [0x1f5ae0, 0xe8681c][slot % 2]); // of its team
const avatar = new Avatar(level.scene, match ? { color: colorOf(match.slot) } : {});
const others = (match?.players ?? []).map((id, slot) => ({ id, slot })).filter(({ slot }) => slot !== match.slot)
    .map((other) => ({ ...other, avatar: new Avatar(level.scene, { color: colorOf(other.slot), isWhole: true }) }));
const desktop = new Desktop(renderer.domElement, world, player);
const hint = new FirstHint();
const ring = makeRing();
const headset = new Headset();
const panel = new Panel(level.names);

// Resolves once the match's world is the server's; else the page stays at the reason.
async function enterMatch() {
    tell('Asking the server', 0);
    try {
        sessionStorage.person ??= newPerson(); // who loads the page again has the slot of before
        const joined = await joinMatch(query.get('join'), { token: query.get('token') ?? '', person: BigInt(sessionStorage.person) });
        while (joined.stage !== 'playing') {
            joined.poll({ sample: {} });
            if (joined.isOver) {
                throw new Error(joined.why);
            }
            tell(joined.stage === 'joining' ? 'Receiving the match' : 'Joining', 0.5);
            await new Promise((resolve) => setTimeout(resolve, 10));
        }
        return joined;
    } catch (error) {
        tell(`${query.get('join')}: ${error.message}`, 1);
        element('back').hidden = false;
        window.demo = { error: error.message, isReady: true };
        await new Promise(() => {}); // there is nothing to play
    }
}
function makeVignette() {
    const ring = new THREE.Mesh(new THREE.RingGeometry(0.11, 1, 48),
        new THREE.MeshBasicMaterial({ color: 0x000000, transparent: true, opacity: 0, depthTest: false }));
    ring.position.z = -0.2;
    ring.renderOrder = 10;
    return ring;
}
// On the surface that a reaching hand would grip.
function makeRing() {
    const mesh = new THREE.Mesh(new THREE.RingGeometry(0.026, 0.032, 32), new THREE.MeshBasicMaterial({ color: 0x46ff6e, side: THREE.DoubleSide }));
    rig.add(mesh);
    return mesh;
}
let notice = ''; // in place of the hint, until the page is loaded again
function say(text) {
    element('help').textContent = text;
    element('help').hidden = text === '';
}
let lastOrigin;
function showAim(pose, dt_s, isShown) {
    const { aim } = desktop;
    element('mark').hidden = !isShown;
    element('mark').classList.toggle('reaches', aim !== null);
    ring.visible = isShown && aim !== null;
    if (ring.visible) {
        ring.position.copy(aim.point).addScaledVector(aim.away, 0.004);
        ring.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), aim.away);
    }
    const grips = [HH_LEFT, HH_RIGHT].some((side) => world.handMovesPlayer(player, side));
    const at = new THREE.Vector3().copy(pose.origin.position);
    hint.advance({ canReach: aim !== null, grips, moved_m: at.distanceTo(lastOrigin ?? at) }, dt_s);
    lastOrigin = at;
    say(notice || (isShown ? hint.text : ''));
}
// The second player: a scripted climber's session, again and again from its spawn. (handhold climb)
async function addClimber() {
    const samples = await loadRecording(new URL('climber.csv', folder));
    const start = startOf(level.spawns[0]);
    const id = world.addPlayer({ name: 'climber', origin: start });
    const figure = await loadFigure(level.scene, world, id, new URL('body.glb', location.href));
    const avatar = new Avatar(level.scene);
    let playback = new Playback(samples);
    const read = (end_s) => {
        if (end_s > begin_s + playback.duration_s) {
            begin_s = end_s;
            playback = new Playback(samples, begin_s);
            world.teleportPlayer(id, start);
        }
        return { player: id, ...playback.read(end_s) };
    };
    let begin_s = 0;
    return { id, read, update: (showsGizmos, dt_s) => {
        figure.update();
        avatar.update(world, id, world.playerPose(id), showsGizmos, dt_s, { figure });
    } };
}
function resize() {
    camera.aspect = innerWidth / innerHeight;
    camera.updateProjectionMatrix();
    renderer.setSize(innerWidth, innerHeight);
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
}
addEventListener('resize', resize);
resize();

// Wrists or controllers, by side: the library is told when that changes.
const usedWrists = [];
function chooseHands(usesWrists) {
    for (const side of [HH_LEFT, HH_RIGHT]) {
        if (usesWrists[side] !== usedWrists[side]) {
            usedWrists[side] = usesWrists[side];
            world.setHandInController(player, side, usesWrists[side] ? {} : null);
        }
    }
}

let last_ms;
const k_recorded_step_s = 1 / 90;
let lag_s = 0; // of a played recording behind the clock
const path = []; // the play space's position after each step of a recording

// Plays a recording in steps of 1/90 s; at its end the panel tells the hash.
function playRecording(dt_s) {
    const k_step_s = k_recorded_step_s;
    const steps = Math.max(1, Math.floor(Number(query.get('seconds') ?? recorded.duration_s) * 90 + 1e-3));
    lag_s = Math.min(lag_s + dt_s, 0.5);
    for (; lag_s >= k_step_s && path.length < steps; lag_s -= k_step_s) {
        world.step(k_step_s, [{ player, ...recorded.read(world.time().time_s + k_step_s) }]);
        path.push(world.playerPose(player).origin.position);
        if (path.length === steps) {
            demo.hash = `0x${world.hash().toString(16).padStart(16, '0')}`;
            notice = `The recording has ended. State hash: ${demo.hash}`;
            say(notice);
        }
    }
}
// A match goes on between pictures, however long those take; only a headset's devices are read in its frames.
let matchDevices = null; // the newest: of the headset, or of mouse and keyboard
let matchRead_ms;
let matchTimer;
let matchDefect = null; // what the match has thrown: it is not stepped any more
function followMatch() {
    const now_ms = performance.now();
    const dt_s = Math.min(1e-3 * (now_ms - (matchRead_ms ?? now_ms)), 1 / 20);
    matchRead_ms = now_ms;
    if (!renderer.xr.isPresenting) {
        const devices = desktop.read(dt_s);
        matchDevices = devices;
        advanceMatch(devices);
    }
}
// Ticks of the match. The controllers' joints are the level's: they are not told.
function advanceMatch(devices) {
    if (matchDefect) {
        return;
    }
    try {
        match.poll(devices);
    } catch (error) {
        matchDefect = error;
        clearInterval(matchTimer);
        console.error(error);
        notice = `The match has ended for you: ${error.message}. Load the page again to join again.`;
        return;
    }
    if (match.isOver) {
        notice = `The match has ended for you: ${match.why}. Load the page again to join again.`;
    } else {
        notice = match.isLost ? `Connection lost: ${match.why}. Trying to return.` : '';
    }
    if (match.player.index !== player.index) { // somebody has taken the slot meanwhile
        location.reload();
    }
}
const matchRows = () => [
    ['score', match.score || 'none'],
    ['you', `player ${match.slot + 1} of ${match.players.length}`],
    ['tracked players', match.players.filter((id) => world.playerPose(id).hands.some((hand) => hand.is_tracked)).length],
    ['ticks ahead', Number(match.stats().tick - match.stats().confirmed)],
];
/** One step of the world with what the devices say. */
function advance(dt_s, { usesWrists, sample, commands }) {
    if (match) {
        advanceMatch({ usesWrists, sample, commands });
        return;
    }
    chooseHands(usesWrists);
    const end_s = world.time().time_s + dt_s;
    world.step(dt_s, [{ player, samples: [{ ...sample, time_s: end_s }], commands }, climber.read(end_s)]);
}
/** Moves what is drawn to where the world has it. */
function show(dt_s, frame_ms) {
    const pose = world.playerPose(player);
    const drawn = match?.drawnPlayer(match.slot, matchDevices) ?? null; // a match's ticks are not the pictures
    place(rig, (drawn ?? pose).origin);
    const bodies = level.movers.map((one) => one.body);
    (match?.drawnBodies(bodies) ?? world.bodyPoses(bodies)).forEach((at, i) => place(level.movers[i].object, at));
    const showsGizmos = element('gizmos').checked;
    avatar.update(world, player, pose, showsGizmos, recorded ? k_recorded_step_s : dt_s, { drawn });
    climber?.update(showsGizmos, dt_s);
    for (const other of others) {
        other.avatar.update(world, other.id, world.playerPose(other.id), showsGizmos, dt_s, { drawn: match.drawnPlayer(other.slot) });
    }
    const v = pose.velocity_mps;
    const speed_mps = Math.hypot(v.x, v.y, v.z);
    const target = element('vignette').checked ? THREE.MathUtils.clamp((speed_mps - 1) / 2, 0, 0.9) : 0;
    vignette.material.opacity += (target - vignette.material.opacity) * Math.min(1, 6 * dt_s);
    vignette.visible = vignette.material.opacity > 0.01;
    panel.update(world, pose, speed_mps, frame_ms, match ? matchRows() : []);
    return pose;
}

let frame_ms = 0;
function onFrame(now_ms, frame) {
    const begin_ms = performance.now();
    const dt_s = Math.min(Math.max(1e-3 * (now_ms - (last_ms ?? now_ms - 14)), 1 / 250), 1 / 20);
    const wall_s = 1e-3 * (now_ms - (last_ms ?? now_ms));
    last_ms = now_ms;
    const space = renderer.xr.getReferenceSpace();
    const inHeadset = renderer.xr.isPresenting && frame !== undefined && frame !== null && space !== null;
    if (recorded) {
        playRecording(wall_s);
    } else if (match && !inHeadset) {
        followMatch(); // up to this picture
        if (matchDevices) {
            place(camera, matchDevices.sample.head);
        }
    } else {
        const devices = inHeadset ? headset.read(frame, space, element('smooth').checked) : desktop.read(dt_s);
        matchDevices = devices;
        advance(dt_s, devices);
        if (!inHeadset) {
            place(camera, devices.sample.head);
        }
    }
    const pose = show(dt_s, frame_ms);
    if (!recorded) {
        showAim(pose, dt_s, !inHeadset);
    }
    if (recorded) { // by the recorded eyes; the camera is at the rig's origin
        place(rig, pose.head);
    }
    if (!isContextLost) {
        renderer.render(level.scene, camera);
    }
    frame_ms = performance.now() - begin_ms;
}

// Keeps all files of the page for a later visit without a network.
async function keepOffline() {
    await navigator.serviceWorker.register('offline.js');
    const files = performance.getEntriesByType('resource').map((entry) => entry.name).filter((name) => name.startsWith(location.origin));
    await (await caches.open('handhold')).addAll([location.href, ...new Set(files)]);
}

// The browser may take the GPU away, as when the computer wakes up. The world goes on; three.js uploads all again on return.
let isContextLost = false;
renderer.domElement.addEventListener('webglcontextlost', (event) => {
    event.preventDefault(); // else it is never restored
    isContextLost = true;
    renderer.xr.getSession()?.end().catch(() => {});
});
renderer.domElement.addEventListener('webglcontextrestored', () => { isContextLost = false; });

async function offerHeadset() {
    const button = element('enter');
    if (!await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false)) {
        return;
    }
    button.disabled = false;
    button.textContent = 'Enter the headset';
    button.addEventListener('click', async () => {
        button.disabled = true; // one session at a time
        try {
            const session = await navigator.xr.requestSession('immersive-vr', { requiredFeatures: ['local-floor'], optionalFeatures: ['hand-tracking'] });
            headset.forget();
            session.addEventListener('end', () => {
                last_ms = undefined;
                button.disabled = false;
            });
            last_ms = undefined;
            await renderer.xr.setSession(session);
        } catch (error) {
            button.disabled = false;
            notice = `The headset could not be entered: ${error.message}`;
            say(notice);
        }
    });
}

element('loading').remove();
element('panel').hidden = false;
window.demo = { handhold, world, player, match, climber, desktop, hint, level, panel, renderer, path, advance, show };
renderer.setAnimationLoop(onFrame);
if (match) {
    matchTimer = setInterval(followMatch, 4);
}
await offerHeadset();
if ('serviceWorker' in navigator && !match) { // not on plain http
    demo.isOffline = keepOffline().then(() => true, (error) => console.warn(`not kept for offline use: ${error.message}`));
}
demo.isReady = true;
