// Players: hands and arms as rounded bones between the joints that the library gives, and the robot's body.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { place } from './level.js';
import { HH_LEFT, HH_LEFT_HAND, HH_LEFT_LOWER_ARM, HH_LEFT_UPPER_ARM, HH_RIGHT, HH_RIGHT_HAND, HH_RIGHT_LOWER_ARM, HH_RIGHT_UPPER_ARM,
    HH_SPACE_PARENT, HH_SPACE_WORLD, HH_CHEST, HH_HEAD, HH_HIPS, HH_LEFT_FOOT, HH_LEFT_LOWER_LEG, HH_LEFT_UPPER_LEG, HH_NECK, HH_RIGHT_FOOT,
    HH_RIGHT_LOWER_LEG, HH_RIGHT_UPPER_LEG } from 'handhold';

// Pairs of joints in the order of XR_EXT_hand_tracking.
const wrist = 1;
const fingers = [[2, 3, 4, 5], [6, 7, 8, 9, 10], [11, 12, 13, 14, 15], [16, 17, 18, 19, 20], [21, 22, 23, 24, 25]];
const handBones = fingers.flatMap((joints) => [[wrist, joints[0]], ...joints.slice(1).map((joint, i) => [joints[i], joint])]);
const armBones = [[HH_LEFT_UPPER_ARM, HH_LEFT_LOWER_ARM], [HH_LEFT_LOWER_ARM, HH_LEFT_HAND], [HH_RIGHT_UPPER_ARM, HH_RIGHT_LOWER_ARM],
    [HH_RIGHT_LOWER_ARM, HH_RIGHT_HAND]];

// Further bones of a whole body, with their radii, m.
const bodyBones = [[HH_HIPS, HH_CHEST, 0.12], [HH_CHEST, HH_NECK, 0.09], [HH_NECK, HH_HEAD, 0.05],
    [HH_LEFT_UPPER_LEG, HH_LEFT_LOWER_LEG, 0.07], [HH_LEFT_LOWER_LEG, HH_LEFT_FOOT, 0.05],
    [HH_RIGHT_UPPER_LEG, HH_RIGHT_LOWER_LEG, 0.07], [HH_RIGHT_LOWER_LEG, HH_RIGHT_FOOT, 0.05]];
const k_head_radius_m = 0.11;

const up = new THREE.Vector3(0, 1, 0);
const from = new THREE.Vector3();
const to = new THREE.Vector3();

const cylinder = new THREE.CylinderGeometry(1, 1, 1, 10, 1, true);
const sphere = new THREE.SphereGeometry(1, 10, 8);

const unit = new THREE.Vector3(1, 1, 1);
const matrixOf = ({ position, rotation }) => new THREE.Matrix4().compose(new THREE.Vector3().copy(position), new THREE.Quaternion().copy(rotation), unit);
// Moves points from where they are stepped to where they are drawn.
function motionTo(drawn, stepped) {
    if (!drawn) {
        return (point) => point;
    }
    const motion = matrixOf(drawn).multiply(matrixOf(stepped).invert());
    return (point) => new THREE.Vector3().copy(point).applyMatrix4(motion);
}

// A cylinder with a ball at the end: bones in a row look like capsules.
function bone(material) {
    const group = new THREE.Group();
    group.add(new THREE.Mesh(cylinder, material), new THREE.Mesh(sphere, material));
    return group;
}
function stretch(group, a, b, radius_m) {
    const [shaft, ball] = group.children;
    from.copy(a);
    to.copy(b);
    ball.position.copy(to);
    ball.scale.setScalar(radius_m);
    shaft.position.lerpVectors(from, to, 0.5);
    to.sub(from);
    shaft.scale.set(radius_m, Math.max(to.length(), 1e-4), radius_m);
    shaft.quaternion.setFromUnitVectors(up, to.normalize());
}

export class Avatar {
    /** color: of the clothes. isWhole: trunk, legs and head too, for players who are seen from outside. */
    constructor(scene, { color = 0x37506e, isWhole = false } = {}) {
        const skin = new THREE.MeshStandardMaterial({ color: 0xd9dfe6, roughness: 0.55 });
        const sleeve = new THREE.MeshStandardMaterial({ color, roughness: 0.8 });
        this.hands = [HH_LEFT, HH_RIGHT].map(() => handBones.map(() => bone(skin)));
        this.arms = armBones.map(() => bone(sleeve));
        this.trunk = isWhole ? bodyBones.map(() => bone(sleeve)) : [];
        this.head = isWhole ? [new THREE.Mesh(sphere, skin)] : [];
        const marker = (color) => new THREE.Mesh(new THREE.SphereGeometry(0.012), new THREE.MeshBasicMaterial({ color, depthTest: false }));
        this.tracked = [marker(0xffb020), marker(0xffb020)];
        this.anchors = [marker(0x30e080), marker(0x30e080)];
        // The force of a hand on what it grips: 1 m for 500 N.
        this.pulls = [HH_LEFT, HH_RIGHT].map(() => new THREE.ArrowHelper(up, new THREE.Vector3(), 1, 0xff5040, 0.05, 0.03));
        scene.add(...this.hands.flat(), ...this.arms, ...this.trunk, ...this.head, ...this.tracked, ...this.anchors, ...this.pulls);
    }

    /** `figure`: what loadFigure returned for the player, if anything; its own hands are then the only ones. `drawn`: of Match.drawnPlayer. */
    update(world, player, pose, showsGizmos, dt_s, { figure, drawn } = {}) {
        const moveHand = [HH_LEFT, HH_RIGHT].map((side) => motionTo(drawn?.hands[side], pose.hands[side].shown));
        const moveHead = motionTo(drawn?.head, pose.head);
        for (const side of [HH_LEFT, HH_RIGHT]) {
            const joints = world.handJoints(player, side, HH_SPACE_WORLD);
            handBones.forEach(([a, b], i) => {
                const mesh = this.hands[side][i];
                mesh.visible = !figure?.hasHands && joints[a].is_valid && joints[b].is_valid;
                if (mesh.visible) {
                    stretch(mesh, moveHand[side](joints[a].pose.position), moveHand[side](joints[b].pose.position), Math.max(joints[b].radius_m, 0.006));
                }
            });
            const hand = pose.hands[side];
            this.tracked[side].visible = showsGizmos;
            this.tracked[side].position.copy(hand.tracked.position);
            this.anchors[side].visible = showsGizmos && hand.grip !== 0;
            this.anchors[side].position.copy(hand.shown.position);
            to.copy(hand.force_impulse_ns).divideScalar(500 * dt_s);
            const length_m = Math.min(to.length(), 1);
            this.pulls[side].visible = showsGizmos && length_m > 0.02;
            if (this.pulls[side].visible) {
                this.pulls[side].position.copy(hand.shown.position);
                this.pulls[side].setDirection(to.normalize());
                this.pulls[side].setLength(length_m, 0.05, 0.03);
            }
        }
        const handJoints = [HH_LEFT_HAND, HH_RIGHT_HAND];
        const body = world.bodyJoints(player, HH_SPACE_WORLD)
            .map(({ position }, joint) => (handJoints.includes(joint) ? moveHand[handJoints.indexOf(joint)] : moveHead)(position));
        armBones.forEach(([a, b], i) => {
            this.arms[i].visible = !figure?.hasHands;
            stretch(this.arms[i], body[a], body[b], 0.035);
        });
        this.trunk.forEach((mesh, i) => stretch(mesh, body[bodyBones[i][0]], body[bodyBones[i][1]], bodyBones[i][2]));
        for (const mesh of this.head) {
            mesh.position.copy(moveHead(pose.head.position));
            mesh.scale.setScalar(k_head_radius_m);
        }
    }
}

/** A figure such as the robot's body (handhold export-body), whose joints the library poses. hasHands: its fingers follow the shown hands. */
export async function loadFigure(scene, world, player, url) {
    const bytes = await (await fetch(url)).arrayBuffer();
    world.setBodyRig(player, new Uint8Array(bytes));
    const { scene: model } = await new GLTFLoader().parseAsync(bytes, '');
    model.traverse((node) => { node.frustumCulled = false; }); // bounds are those of the rest pose
    scene.add(model);
    const bones = world.skeleton(player, HH_SPACE_PARENT).map((_, i) => {
        const { name } = world.skeletonJoint(player, i);
        return model.getObjectByName(THREE.PropertyBinding.sanitizeNodeName(name));
    });
    const hasHands = [HH_LEFT, HH_RIGHT].every((side) => world.skeletonFingers(player, side) > 1);
    return { hasHands, update: () => world.skeleton(player, HH_SPACE_PARENT).forEach((pose, i) => place(bones[i], pose)) };
}
