// What the player's devices say: a headset by WebXR, or mouse and keyboard. Both give samples of the
// library (hh_tracking_sample) and commands.
import * as THREE from 'three';
import { HH_LEFT, HH_RIGHT } from 'handhold';

const sides = [HH_LEFT, HH_RIGHT];
const plain = ({ position: p, quaternion: q }) => ({ position: { x: p.x, y: p.y, z: p.z }, rotation: { x: q.x, y: q.y, z: q.z, w: q.w } });

// As game/devices/desktop_body.cpp.
const k_head = { x: 0, y: 1.6, z: 0 };
const k_arm_m = 0.78; // from the shoulder
const k_face_m = 0.15; // a pulling hand comes no nearer to the head
const k_look_m = 0.85;
const k_near_look_m = 0.08; // a surface so near to the line of sight counts as in view
const k_no_surface_m = 0.6;
const k_reach_mps = 3.5;
const k_return_mps = 2.5;
const k_longest_reach_s = 0.5;
const k_hand_radius_m = 0.04;
const k_fingers_m = 0.08;
const k_pull_m = 1.2e-3; // of a hand, for a pixel of the mouse
const vector = ({ x, y, z }) => new THREE.Vector3(x, y, z);
const numbers = ({ x, y, z }) => ({ x, y, z });
const mirroredTo = (side, { x, y, z }) => new THREE.Vector3(side === HH_LEFT ? -x : x, y, z);

/** Mouse and keyboard: a hand whose button is down reaches for the surface in view, closes there, and then moves with the mouse. */
export class Desktop {
    #world;
    #player;
    #palmCenter;
    #hands = [HH_LEFT, HH_RIGHT].map((side) => ({ side, position: null, rotation: new THREE.Quaternion(), reaches_s: 0, closed: false }));
    constructor(element, world, player) {
        this.#world = world;
        this.#player = player;
        const [x, y, z] = world.getTuning('hand.palm_center_m', 3);
        this.#palmCenter = { x, y, z };
        this.yaw = 0;
        this.pitch = 0;
        this.aim = null; // {point, away} in play space: what a hand that reaches now grips
        this.pressed = [false, false];
        this.keys = new Set();
        element.addEventListener('click', () => element.requestPointerLock?.());
        element.addEventListener('contextmenu', (event) => event.preventDefault());
        addEventListener('keydown', (event) => { if (event.target?.tagName !== 'INPUT') this.keys.add(event.code); });
        addEventListener('keyup', (event) => this.keys.delete(event.code));
        addEventListener('blur', () => { this.keys.clear(); this.pressed.fill(false); });
        const button = (event, down) => {
            const side = { 0: HH_LEFT, 2: HH_RIGHT }[event.button];
            if (side !== undefined && (document.pointerLockElement === element || !down)) {
                this.pressed[side] = down;
            }
        };
        addEventListener('mousedown', (event) => button(event, true));
        addEventListener('mouseup', (event) => button(event, false));
        addEventListener('wheel', (event) => this.#pull(0, 0, 5e-4 * event.deltaY));
        addEventListener('mousemove', (event) => {
            if (document.pointerLockElement === element) {
                this.move(event.movementX, event.movementY);
            }
        });
    }
    /** The mouse has moved by so many pixels: it looks, or moves the closed hands. */
    move(x, y) {
        if (this.#hands.some((hand) => hand.closed)) {
            this.#pull(k_pull_m * x, -k_pull_m * y, 0);
        } else {
            this.yaw -= 2.5e-3 * x;
            this.pitch = THREE.MathUtils.clamp(this.pitch - 2.5e-3 * y, -1.4, 1.4);
        }
    }
    /** What the devices say, `dt_s` after the last time. */
    read(dt_s) {
        this.#lookForSurface();
        for (const hand of this.#hands) {
            const rest = this.#handOn(this.#atHead(mirroredTo(hand.side, { x: 0.2, y: -0.24, z: -0.42 })),
                mirroredTo(hand.side, { x: 0.5, y: 0.85, z: 0 }).normalize(), new THREE.Vector3(0, 0, -1), hand.side);
            if (hand.position === null) {
                Object.assign(hand, { position: rest.position, rotation: rest.rotation });
            }
            if (!this.pressed[hand.side]) {
                Object.assign(hand, { closed: false, reaches_s: 0 });
                this.#approach(hand, rest, k_return_mps * dt_s);
                this.#stopAtSurface(hand);
            } else if (!hand.closed) {
                hand.reaches_s += dt_s;
                const arrived = this.#approach(hand, this.#target(hand.side), k_reach_mps * dt_s);
                hand.closed = arrived || hand.reaches_s > k_longest_reach_s;
            }
        }
        const axis = (plus, minus) => Number(this.keys.has(plus)) - Number(this.keys.has(minus));
        const thrust = new THREE.Vector3(axis('KeyD', 'KeyA'), axis('KeyE', 'KeyQ'), axis('KeyS', 'KeyW')).applyQuaternion(this.#view());
        return {
            usesWrists: [true, true],
            sample: {
                head: plain({ position: k_head, quaternion: this.#view() }),
                hands: this.#hands.map((hand) => plain({ position: hand.position, quaternion: hand.rotation })),
                grab: this.#hands.map((hand) => hand.closed),
            },
            commands: { thrust: numbers(thrust), brake: this.keys.has('KeyX') ? 1 : 0 },
        };
    }

    #view() {
        return new THREE.Quaternion().setFromEuler(new THREE.Euler(this.pitch, this.yaw, 0, 'YXZ'));
    }
    #atHead(place) {
        return place.applyQuaternion(this.#view()).add(vector(k_head));
    }
    // The play space in the world, as a matrix.
    #origin() {
        const { position, rotation } = this.#world.playerPose(this.#player).origin;
        return new THREE.Matrix4().compose(vector(position), new THREE.Quaternion(rotation.x, rotation.y, rotation.z, rotation.w), new THREE.Vector3(1, 1, 1));
    }
    #lookForSurface() {
        const origin = this.#origin();
        const eyes = vector(k_head).applyMatrix4(origin);
        const end = this.#atHead(new THREE.Vector3(0, 0, -k_look_m)).applyMatrix4(origin);
        const query = [numbers(eyes), numbers(end), this.#player];
        const hit = found(this.#world.castRay(...query)) ?? found(this.#world.castSphere(k_near_look_m, ...query));
        this.aim = hit && { point: vector(hit.point).applyMatrix4(origin.clone().invert()), away: vector(hit.normal).transformDirection(origin.clone().invert()) };
    }
    #target(side) {
        const view = this.#view();
        if (this.aim === null) {
            return this.#handOn(this.#atHead(new THREE.Vector3(0, 0, -k_no_surface_m)), new THREE.Vector3(0, 1, 0).applyQuaternion(view),
                new THREE.Vector3(0, 0, -1), side);
        }
        return this.#handOn(this.aim.point, this.aim.away, new THREE.Vector3(0, 1, -0.3), side);
    }
    // The wrist of a hand whose palm is at `palm`, its back to `away`, its fingers towards `ahead` in the view. game/session/hand_pose.hpp
    #handOn(palm, away, ahead, side) {
        const view = this.#view();
        const backwards = ahead.clone().applyQuaternion(view).projectOnPlane(away).negate();
        if (backwards.length() < 0.1) {
            backwards.set(-1, 0, 0).applyQuaternion(view).projectOnPlane(away);
        }
        backwards.normalize();
        const rotation = new THREE.Quaternion().setFromRotationMatrix(
            new THREE.Matrix4().makeBasis(new THREE.Vector3().crossVectors(away, backwards), away, backwards));
        return { position: palm.clone().sub(this.#palm(side).applyQuaternion(rotation)), rotation };
    }
    #palm(side) {
        return mirroredTo(side, this.#palmCenter);
    }
    // True at the target.
    #approach(hand, target, step_m) {
        const distance_m = hand.position.distanceTo(target.position);
        const share = distance_m > 0.005 ? Math.min(1, step_m / distance_m) : 1;
        hand.position.lerp(target.position, share);
        hand.rotation.slerp(target.rotation, share);
        return share === 1;
    }
    // Moves an open hand back towards the head until neither palm nor fingers are in a surface.
    #stopAtSurface(hand) {
        const origin = this.#origin();
        const eyes = vector(k_head);
        for (const ahead_m of [0, k_fingers_m]) {
            const part = this.#palm(hand.side).add(new THREE.Vector3(0, 0, -ahead_m)).applyQuaternion(hand.rotation).add(hand.position);
            const hit = found(this.#world.castSphere(k_hand_radius_m, numbers(eyes.clone().applyMatrix4(origin)), numbers(part.clone().applyMatrix4(origin)), this.#player));
            if (hit !== null && hit.distance_m > 0) {
                const way = part.sub(eyes);
                hand.position.addScaledVector(way, -Math.max(0, 1 - hit.distance_m / way.length()));
            }
        }
    }
    // Moves all closed hands, if none leaves its arm's reach or comes too near to the face.
    #pull(x, y, z) {
        const step = new THREE.Vector3(x, y, z).applyQuaternion(this.#view());
        const closed = this.#hands.filter((hand) => hand.closed);
        const may = closed.every((hand) => {
            const next = hand.position.clone().add(step);
            const shoulder = this.#atHead(mirroredTo(hand.side, { x: 0.18, y: -0.2, z: 0.05 }));
            const away = (place, from) => place.distanceTo(from);
            const out = away(next, shoulder) > k_arm_m && away(next, shoulder) > away(hand.position, shoulder);
            const near = away(next, vector(k_head)) < k_face_m && away(next, vector(k_head)) < away(hand.position, vector(k_head));
            return !out && !near;
        });
        if (may) {
            closed.forEach((hand) => hand.position.add(step));
        }
    }
}
// A query's answer; null: nothing is there.
const found = (hit) => (hit.body.generation === 0 && hit.player.generation === 0 ? null : hit);

/** Says what to do next until somebody who plays for the first time has gripped and pulled once. As game/ui/first_hint.cpp. */
export class FirstHint {
    #step = 'look';
    #pulled_m = 0;
    #again_s = 0;
    advance({ canReach, grips, moved_m }, dt_s) {
        if (this.#step === 'again' || this.#step === 'gone') {
            this.#again_s += dt_s;
            this.#step = this.#again_s < 6 ? 'again' : 'gone';
            return;
        }
        this.#pulled_m = grips ? this.#pulled_m + moved_m : 0;
        this.#step = this.#pulled_m > 0.3 ? 'again' : grips ? 'pull' : canReach ? 'press' : 'look';
    }
    get text() {
        return {
            look: 'Click, then look at something near with the mouse: the mark turns green where a hand can reach',
            press: 'Hold the left or the right mouse button: that hand grips at the ring',
            pull: 'Hold on, and move the mouse: you pull yourself along',
            again: 'Let go to float, grip again to stop',
            gone: '',
        }[this.#step];
    }
}

// As game/devices/headset_hands.cpp: tests/game/devices/headset_cases.json is played by both.
const k_closes = 0.55;
const k_opens = 0.35;
const k_dead_stick = 0.18;
const k_snap_stick = 0.7;
const k_fingers = ['middle', 'ring', 'pinky']; // index and thumb may point while the hand is closed
// The joints of each finger, from the one before its first bend to the tip, and the bends' sum in a fist,
// radians: systems/rigs/finger_curls.cpp, with the fist of systems/rigs/hand_limits.cpp.
const k_bends = [
    ['thumb-metacarpal', 'thumb-phalanx-proximal', 'thumb-phalanx-distal', 'thumb-tip'],
    ...['index', 'middle', 'ring', 'pinky'].map((name) => ['metacarpal', 'phalanx-proximal', 'phalanx-intermediate', 'phalanx-distal', 'tip'].map((joint) => `${name}-finger-${joint}`)),
];
const k_fist_bends = [50 + 65, ...Array(4).fill(110 + 105 + 75)].map((degrees) => degrees * Math.PI / 180);
const k_unknown_curl = -1;
const unknownCurls = () => Array(5).fill(k_unknown_curl);
const k_open_palm_m = 0.19; // from the palm to the tips of straight fingers, as the curl has it where no knuckle is known

/** What one side's devices said so far. */
const forgotten = () => ({ grabs: false, usesWrists: false, curl: 0, fingers: unknownCurls(), isTransient: false });

/** Controllers or tracked hands by WebXR. */
export class Headset {
    #session;
    #turned = false;
    #hands = [forgotten(), forgotten()];
    #pressed = new Map(); // by input source: {select, squeeze}, told by events: sources without a gamepad have no other buttons

    /** turnsSmoothly: the right stick turns at a rate, else a push turns by the tuning's snap angle. */
    read(frame, space, turnsSmoothly) {
        this.#enter(frame.session);
        const viewer = frame.getViewerPose(space);
        const sample = { head_tracked: viewer !== undefined && viewer !== null, head_inferred: viewer?.emulatedPosition ?? false, hand_tracked: [false, false], hand_inferred: [false, false],
            grab: [false, false], squeeze: [0, 0], trigger: [0, 0], hands: [{}, {}], curls: [{}, {}] };
        if (sample.head_tracked) {
            sample.head = transform(viewer.transform);
        }
        const commands = {};
        // A menu of the system covers the game: its devices move that. Hands count as lost, buttons as they were.
        const hasFocus = (frame.session.visibilityState ?? 'visible') === 'visible';
        const readings = sides.map((side) => (hasFocus ? this.#readSide(frame, space, side) : undefined));
        readings.forEach((reading, side) => this.#take(reading, side, sample, hasFocus));
        if (hasFocus) {
            this.#command(readings, sample, turnsSmoothly, commands);
        }
        return { usesWrists: this.#hands.map((hand) => hand.usesWrists), sample, commands };
    }

    /** A session begins with open hands; called when the one before ends. */
    forget() {
        this.#turned = false;
        this.#hands = [forgotten(), forgotten()];
        this.#pressed.clear();
    }

    #enter(session) {
        if (session === this.#session) {
            return;
        }
        this.#session = session;
        for (const [event, button, down] of [['selectstart', 'select', true], ['selectend', 'select', false], ['squeezestart', 'squeeze', true], ['squeezeend', 'squeeze', false]]) {
            session.addEventListener?.(event, ({ inputSource }) => { this.#pressed.set(inputSource, { ...this.#pressed.get(inputSource), [button]: down }); });
        }
        session.addEventListener?.('inputsourceschange', ({ removed }) => { for (const source of removed ?? []) this.#pressed.delete(source); });
        session.addEventListener?.('end', () => this.forget());
    }

    // The reading of the side's best source: a controller, tracked fingers, then what stands for a pinch that is no device.
    #readSide(frame, space, side) {
        const sources = [...frame.session.inputSources].filter((source) => ({ left: HH_LEFT, right: HH_RIGHT })[source.handedness] === side);
        const readings = [];
        for (const source of sources) {
            if (source.hand && frame.getJointPose) {
                readings.push({ rank: 1, ...this.#readFingers(frame, space, source.hand) });
            } else if (source.gripSpace) {
                const isTransient = source.targetRayMode === 'transient-pointer';
                readings.push({ rank: isTransient ? 2 : 0, isTransient, ...this.#readController(frame, space, source, isTransient) });
            }
        }
        const best = (list) => list.reduce((a, b) => (a !== undefined && a.rank <= b.rank ? a : b), undefined);
        // A controller that lies on the table, unseen, leaves the side to the fingers.
        return best(readings.filter((reading) => reading.pose !== undefined && !reading.isInferred)) ?? best(readings.filter((reading) => reading.rank < 2)) ?? best(readings);
    }

    #readController(frame, space, source, isTransient) {
        const pose = frame.getPose(source.gripSpace, space);
        const told = this.#pressed.get(source) ?? {};
        const buttons = source.gamepad?.buttons;
        const value = (button) => Math.max(button?.value ?? 0, button?.pressed && !(button.value > 0) ? 1 : 0);
        const axes = source.gamepad?.axes ?? [];
        const stick = axes.length >= 4 ? [axes[2], axes[3]] : [axes[0] ?? 0, axes[1] ?? 0]; // a touchpad where there is no stick
        return {
            ...tracked(pose), usesWrists: false,
            trigger: isTransient ? 1 : buttons ? value(buttons[0]) : Number(told.select ?? false), // a transient source lives as long as its pinch
            squeeze: buttons ? value(buttons[1]) : Number(told.squeeze ?? false),
            stick: [stick[0], -stick[1]],
            brake: (buttons?.[4] ?? buttons?.[2])?.pressed ?? false,
            calibrate: buttons?.[5]?.pressed ?? false,
        };
    }

    // The curl is the mean of the fingers that are known; unknown if none is.
    #readFingers(frame, space, hand) {
        const pose = (name) => frame.getJointPose(hand.get(name), space) ?? undefined;
        const wrist = pose('wrist');
        const place = (name) => pose(name)?.transform.position;
        const palm = place('middle-finger-metacarpal');
        const curls = wrist === undefined ? [] : k_fingers.map((finger) => {
            const tip = place(`${finger}-finger-tip`);
            const knuckle = place(`${finger}-finger-phalanx-proximal`);
            if (tip === undefined || (knuckle === undefined && palm === undefined)) {
                return undefined;
            }
            return knuckle === undefined ? 1 - length(minus(tip, palm)) / k_open_palm_m : fingerCurl(wrist.transform.position, knuckle, tip);
        }).filter((curl) => curl !== undefined && Number.isFinite(curl));
        return {
            ...tracked(wrist), usesWrists: true, trigger: 0, squeeze: 0, stick: [0, 0], brake: false, calibrate: false,
            curl: curls.length === 0 ? undefined : curls.reduce((sum, curl) => sum + curl, 0) / curls.length,
            fingers: k_bends.map((joints, finger) => fingerBend(joints.map(place)) / k_fist_bends[finger]),
        };
    }

    // A hand that is not seen keeps its button: losing sight of it does not open it.
    #take(reading, side, sample, hasFocus) {
        const memory = this.#hands[side];
        if (reading !== undefined) {
            memory.usesWrists = reading.usesWrists;
        }
        if (reading?.pose !== undefined && !reading.isInferred) {
            memory.curl = reading.usesWrists ? reading.curl ?? memory.curl : 0;
            memory.fingers = reading.usesWrists ? reading.fingers.map((curl, i) => (curl >= 0 ? Math.min(1, curl) : memory.fingers[i])) : unknownCurls(); // as they were last, where not seen
            const closes = Math.max(reading.squeeze, reading.trigger, memory.curl);
            memory.grabs = closes > (memory.grabs ? k_opens : k_closes);
            sample.hand_tracked[side] = true;
            sample.hands[side] = reading.pose;
            sample.squeeze[side] = Math.min(1, Math.max(0, closes));
            sample.trigger[side] = reading.trigger;
        } else if (reading?.pose !== undefined) { // a guess: shown, but it neither grips nor moves the player
            sample.hand_inferred[side] = true;
            sample.hands[side] = reading.pose;
        } else if (reading === undefined && memory.isTransient && hasFocus) {
            memory.grabs = false; // the pinch has ended, and with it its source
        }
        memory.isTransient = reading?.isTransient ?? (memory.isTransient && memory.grabs);
        sample.grab[side] = memory.grabs;
        sample.curls[side] = { fingers: [...memory.fingers] };
    }

    #command(readings, sample, turnsSmoothly, commands) {
        const stick = (side) => readings[side]?.stick ?? [0, 0];
        const turn = stick(HH_RIGHT)[0];
        if (turnsSmoothly) {
            commands.smooth_turn = -pastDeadZone(turn);
        } else if (Math.abs(turn) > k_snap_stick) {
            commands.snap_turns = this.#turned ? 0 : turn > 0 ? -1 : 1;
            this.#turned = true;
        } else if (pastDeadZone(turn) === 0) {
            this.#turned = false;
        }
        commands.brake = readings.some((reading) => reading?.brake) ? 1 : 0;
        commands.calibrate = readings.every((reading) => reading?.calibrate);
        if (sample.head_tracked) {
            const [x, y] = stick(HH_LEFT).map(pastDeadZone);
            commands.thrust = turned(sample.head.rotation, { x, y: 0, z: -y });
        }
    }
}

function pastDeadZone(value) {
    return Math.sign(value) * Math.min(1, Math.max(0, (Math.abs(value) - k_dead_stick) / (1 - k_dead_stick)));
}
const minus = (a, b) => ({ x: a.x - b.x, y: a.y - b.y, z: a.z - b.z });
const dot = (a, b) => a.x * b.x + a.y * b.y + a.z * b.z;
const length = (a) => Math.hypot(a.x, a.y, a.z);
// 0 in line with the hand, 1 if the finger points back at the wrist; undefined for lengths that no finger has.
function fingerCurl(wrist, knuckle, tip) {
    const [hand, finger] = [minus(knuckle, wrist), minus(tip, knuckle)];
    const cosine = dot(hand, finger) / (length(hand) * length(finger));
    return length(finger) < 4 * length(hand) ? Math.min(1, Math.max(0, 0.5 * (1 - cosine))) : undefined;
}
// Sum of the angles between a finger's bones, radians; NaN if a joint is not seen or two lie in one place.
function fingerBend(joints) {
    const bones = joints.slice(1).map((joint, i) => (joint && joints[i] ? minus(joint, joints[i]) : { x: NaN, y: NaN, z: NaN }));
    return bones.slice(1).reduce((sum, after, i) => {
        const before = bones[i];
        const across = { x: before.y * after.z - before.z * after.y, y: before.z * after.x - before.x * after.z, z: before.x * after.y - before.y * after.x };
        return length(before) > 1e-4 && length(after) > 1e-4 ? sum + Math.atan2(length(across), dot(before, after)) : NaN;
    }, 0);
}
function turned(q, v) {
    const cross = (a, b) => ({ x: a.y * b.z - a.z * b.y, y: a.z * b.x - a.x * b.z, z: a.x * b.y - a.y * b.x });
    const t = cross(q, v);
    const u = cross(q, { x: t.x + q.w * v.x, y: t.y + q.w * v.y, z: t.z + q.w * v.z });
    return { x: v.x + 2 * u.x, y: v.y + 2 * u.y, z: v.z + 2 * u.z };
}
// A pose that the runtime infers, as from the head while no camera sees the device, is a guess.
const tracked = (pose) => ({ pose: pose ? transform(pose.transform) : undefined, isInferred: pose?.emulatedPosition ?? false });
function transform({ position: p, orientation: q }) {
    return { position: { x: p.x, y: p.y, z: p.z }, rotation: { x: q.x, y: q.y, z: q.z, w: q.w } };
}
