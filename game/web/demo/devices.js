// What the player's devices say: a headset by WebXR, or mouse and keyboard. Both give samples of the
// library (hh_tracking_sample) and commands.
import * as THREE from 'three';
import { HH_LEFT, HH_RIGHT } from 'handhold';

const sides = [HH_LEFT, HH_RIGHT];
const plain = ({ position: p, quaternion: q }) => ({ position: { x: p.x, y: p.y, z: p.z }, rotation: { x: q.x, y: q.y, z: q.z, w: q.w } });

/** Mouse and keyboard: the hands float before the eyes; while one is closed, the mouse moves the hands. */
export class Desktop {
    constructor(element) {
        this.yaw = 0;
        this.pitch = 0;
        this.offset = new THREE.Vector3(); // of the hands from their rest
        this.closed = [false, false];
        this.keys = new Set();
        element.addEventListener('click', () => element.requestPointerLock?.());
        element.addEventListener('contextmenu', (event) => event.preventDefault());
        addEventListener('keydown', (event) => this.keys.add(event.code));
        addEventListener('keyup', (event) => this.keys.delete(event.code));
        addEventListener('blur', () => { this.keys.clear(); this.closed.fill(false); });
        const button = (event, down) => {
            const side = { 0: HH_LEFT, 2: HH_RIGHT }[event.button];
            if (side !== undefined && (document.pointerLockElement === element || !down)) {
                this.closed[side] = down;
            }
        };
        addEventListener('mousedown', (event) => button(event, true));
        addEventListener('mouseup', (event) => button(event, false));
        addEventListener('wheel', (event) => { this.offset.z = THREE.MathUtils.clamp(this.offset.z + 5e-4 * event.deltaY, -0.25, 0.3); });
        addEventListener('mousemove', (event) => {
            if (document.pointerLockElement === element) {
                this.move(event.movementX, event.movementY);
            }
        });
    }
    move(x, y) {
        if (this.closed.includes(true)) {
            this.offset.x = THREE.MathUtils.clamp(this.offset.x + 1.2e-3 * x, -0.45, 0.45);
            this.offset.y = THREE.MathUtils.clamp(this.offset.y - 1.2e-3 * y, -0.5, 0.45);
        } else {
            this.yaw -= 2.5e-3 * x;
            this.pitch = THREE.MathUtils.clamp(this.pitch - 2.5e-3 * y, -1.4, 1.4);
        }
    }
    read(dt_s) {
        if (!this.closed.includes(true)) {
            this.offset.x *= Math.exp(-4 * dt_s); // open hands come back before the eyes
            this.offset.y *= Math.exp(-4 * dt_s);
        }
        const head = new THREE.Object3D();
        head.position.set(0, 1.6, 0);
        head.rotation.set(this.pitch, this.yaw, 0, 'YXZ');
        const hands = sides.map((side) => {
            const hand = new THREE.Object3D();
            hand.position.set(side === HH_LEFT ? -0.2 : 0.2, -0.22, -0.42).add(this.offset).applyQuaternion(head.quaternion).add(head.position);
            hand.quaternion.copy(head.quaternion).multiply(new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(1, 0, 0), 0.9));
            return hand;
        });
        const axis = (plus, minus) => Number(this.keys.has(plus)) - Number(this.keys.has(minus));
        const thrust = new THREE.Vector3(axis('KeyD', 'KeyA'), axis('KeyE', 'KeyQ'), axis('KeyS', 'KeyW')).applyQuaternion(head.quaternion);
        return {
            usesWrists: true,
            sample: { head: plain(head), hands: hands.map(plain), grab: [...this.closed] },
            commands: { thrust: { x: thrust.x, y: thrust.y, z: thrust.z }, brake: this.keys.has('KeyX') ? 1 : 0 },
        };
    }
}

/** Controllers or tracked hands by WebXR. */
export class Headset {
    #turned = false;

    /** turnsSmoothly: the stick turns at a rate, else a flick turns by the tuning's snap angle. */
    read(frame, space, turnsSmoothly) {
        const viewer = frame.getViewerPose(space);
        const sample = { head_tracked: viewer !== undefined && viewer !== null, hand_tracked: [false, false], grab: [false, false], squeeze: [0, 0], trigger: [0, 0], hands: [{}, {}] };
        if (sample.head_tracked) {
            sample.head = transform(viewer.transform);
        }
        let usesWrists = false;
        const commands = {};
        for (const source of frame.session.inputSources) {
            const side = { left: HH_LEFT, right: HH_RIGHT }[source.handedness];
            if (side === undefined) {
                continue;
            }
            if (source.hand && frame.getJointPose) {
                usesWrists = true;
                this.#readHand(frame, space, source.hand, side, sample);
            } else if (source.gripSpace) {
                const pose = frame.getPose(source.gripSpace, space);
                if (pose) {
                    sample.hand_tracked[side] = true;
                    sample.hands[side] = transform(pose.transform);
                }
                const buttons = source.gamepad?.buttons ?? [];
                sample.grab[side] = (buttons[0]?.pressed ?? false) || (buttons[1]?.pressed ?? false);
                sample.squeeze[side] = Math.max(buttons[0]?.value ?? 0, buttons[1]?.value ?? 0);
                sample.trigger[side] = buttons[0]?.value ?? 0;
                if (side === HH_RIGHT) {
                    this.#readStick(source.gamepad?.axes ?? [], turnsSmoothly, commands);
                }
                commands.brake = Math.max(commands.brake ?? 0, buttons[4]?.pressed ? 1 : 0);
            }
        }
        return { usesWrists, sample, commands };
    }
    // A hand is closed when its middle and ring tips are near the palm.
    #readHand(frame, space, hand, side, sample) {
        const pose = (name) => frame.getJointPose(hand.get(name), space);
        const wrist = pose('wrist');
        const palm = pose('middle-finger-metacarpal');
        const tips = [pose('middle-finger-tip'), pose('ring-finger-tip')];
        if (!wrist || !palm || tips.includes(null) || tips.includes(undefined)) {
            return;
        }
        sample.hand_tracked[side] = true;
        sample.hands[side] = transform(wrist.transform);
        const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
        sample.grab[side] = tips.every((tip) => distance(tip.transform.position, palm.transform.position) < 0.085);
    }
    #readStick(axes, turnsSmoothly, commands) {
        const x = axes[2] ?? 0;
        if (turnsSmoothly) {
            commands.smooth_turn = Math.abs(x) > 0.15 ? -x : 0;
            return;
        }
        if (Math.abs(x) < 0.4) {
            this.#turned = false;
        } else if (Math.abs(x) > 0.7 && !this.#turned) {
            this.#turned = true;
            commands.snap_turns = x > 0 ? -1 : 1;
        }
    }
}

function transform({ position: p, orientation: q }) {
    return { position: { x: p.x, y: p.y, z: p.z }, rotation: { x: q.x, y: q.y, z: q.z, w: q.w } };
}
