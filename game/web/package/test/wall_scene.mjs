// The scene of tests/bindings/wall_hash.c, call by call: a host whose own physics moves the player.
export function playWall(handhold, { HH_EVENT_GRABBED, HH_LEFT, HH_RIGHT }) {
    const wallZ = -0.5;
    const step = 1 / 90;
    const vec = (x, y, z) => ({ x, y, z });
    const world = handhold.createWorld();
    let wall;
    let calls = 0;
    const isSkipped = (skip) => skip.some((one) => one.index === wall.index && one.generation === wall.generation);
    const hit = (x, y, distance_m) => ({ body: wall, point: vec(x, y, wallZ), normal: vec(0, 0, 1), distance_m });
    const closest = (point, max, skip) => {
        const distance = point.z < wallZ ? 0 : point.z - wallZ;
        ++calls;
        return isSkipped(skip) || distance > max ? null : hit(point.x, point.y, distance);
    };
    world.setSurfaceQuery({
        cast_ray(from, to, skip) {
            ++calls;
            if (isSkipped(skip) || from.z < wallZ || to.z >= wallZ) {
                return null;
            }
            const part = (from.z - wallZ) / (from.z - to.z);
            return hit(from.x + part * (to.x - from.x), from.y + part * (to.y - from.y), 0);
        },
        closest_point: closest,
        closest_point_on: (body, point) => (body.index === wall.index ? closest(point, 1e9, []) : null),
    });
    wall = world.addBody({ name: 'wall', pose: { position: vec(0, 1.5, wallZ) } });
    const player = world.addPlayer({ name: 'you' });
    world.setHandInController(player, HH_LEFT, {});
    world.setHandInController(player, HH_RIGHT, {});
    const rotation = { x: 0.70710678118654757, y: 0, z: 0, w: 0.70710678118654757 };
    const clamped = (x) => Math.min(Math.max(x, 0), 1);
    let grabs = 0;
    for (let frame = 1; frame <= 180; ++frame) {
        const time_s = frame / 90;
        const hands = [{ position: vec(-0.2, 1.4, -0.43), rotation },
            { position: vec(0.2, 1.4, -0.43 + 0.2 * clamped(2 * (time_s - 1))), rotation }];
        const sample = { time_s, head: { position: vec(0, 1.6, 0) }, hands, grab: [false, time_s >= 0.5] };
        world.beginStep(step, [{ player, samples: [sample] }]);
        const [{ origin: start, velocity_mps: speed }] = world.playerMotions();
        let end = vec(start.x + step * speed.x, start.y + step * speed.y, start.z + step * speed.z);
        for (const { anchor_end, target } of world.handConstraints()) {
            const [a, b] = [anchor_end.position, target.position];
            end = vec(a.x - b.x, a.y - b.y, a.z - b.z);
        }
        const velocity_mps = vec((end.x - start.x) / step, (end.y - start.y) / step, (end.z - start.z) / step);
        world.endStep([{ player, origin: end, velocity_mps }]);
        grabs += world.events().filter(({ kind }) => kind === HH_EVENT_GRABBED).length;
    }
    const moved = -1000 * world.playerPose(player).origin.position.z;
    const line = `0x${world.hash().toString(16).padStart(16, '0')} grabs ${grabs} moved_mm ${moved.toFixed(3)}`;
    world.destroy();
    return { line, calls };
}
