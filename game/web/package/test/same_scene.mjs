// The scene of tests/portability/grip_hash.c, call by call. Runs in Node and in browsers.
export function playSameScene(handhold, { HH_BALL, HH_DYNAMIC, HH_LEFT, HH_RIGHT }) {
    const frames = 270;
    const world = handhold.createWorld();
    const vec = (x, y, z) => ({ x, y, z });
    const clamped = (x) => Math.min(Math.max(x, 0), 1);

    const wall = world.addBox(vec(1, 2, 0.1));
    world.addBody({ name: 'wall', shape: wall, pose: { position: vec(0.95, 1.5, -0.6) } });

    const link = world.addCapsule(0.03, 0.05);
    let last;
    for (let i = 0; i < 12; ++i) {
        const body = world.addBody({
            name: `link${i}`, kind: HH_DYNAMIC, shape: link, mass_kg: 0.5,
            pose: { position: vec(-0.2, 1.4 + 0.125 * i, -0.52) },
        });
        if (i > 0) {
            world.addJoint({
                kind: HH_BALL, body_a: last, body_b: body,
                frame: { position: vec(-0.2, 1.4 + 0.125 * i - 0.0625, -0.52) },
            });
        }
        last = body;
    }

    const box = world.addBox(vec(0.15, 0.1, 0.12));
    const hull = world.addHull([vec(0, 0.2, 0), vec(0.2, -0.1, 0), vec(-0.1, -0.1, 0.15), vec(-0.1, -0.1, -0.15)]);
    for (let i = 0; i < 20; ++i) {
        world.addBody({
            name: `crate${i}`, kind: HH_DYNAMIC, shape: i % 2 === 0 ? box : hull, mass_kg: 1 + 0.25 * i,
            pose: { position: vec(0.3 * (i % 5) - 0.6, 0.5 + 0.35 * Math.floor(i / 5), -1.5) },
            velocity_mps: vec(0.1 * (i % 3) - 0.1, 0.02 * i - 0.2, 0.3 - 0.03 * i),
            angular_velocity_radps: vec(0.5, 0.1 * i, -0.3),
        });
    }

    const player = world.addPlayer({ name: 'you' });
    world.setHandInController(player, HH_LEFT, {});
    world.setHandInController(player, HH_RIGHT, {});
    const rotation = { x: 0.70710678118654757, y: 0, z: 0, w: 0.70710678118654757 };
    const steps_us = [];
    const begin_ms = performance.now();
    for (let frame = 1; frame <= frames; ++frame) {
        const time_s = frame / 90;
        const swing = clamped(time_s - 1) - 2 * clamped(time_s - 1.5) + clamped(2 * time_s - 4.5);
        const hands = [
            { position: vec(-0.2 - 0.4 * swing, 1.4, -0.43), rotation },
            { position: vec(0.2, 1.4 - 0.3 * clamped(time_s - 1), -0.43), rotation },
        ];
        const grab = [time_s >= 0.5, time_s >= 0.5];
        world.step(1 / 90, [{ player, samples: [{ time_s, head: { position: vec(0, 1.6, 0) }, hands, grab }] }]);
        steps_us.push(world.stats().step_us);
    }
    const mean_us = (1000 * (performance.now() - begin_ms)) / frames;
    const pose = world.playerPose(player);
    const hash = world.hash().toString(16).padStart(16, '0');
    world.destroy();
    const step_us = steps_us.sort((a, b) => a - b)[frames / 2];
    return { hash: `0x${hash}`, grips: pose.hands.map((hand) => hand.grip), step_us, mean_us };
}
