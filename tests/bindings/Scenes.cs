// The scenes of tests/portability/grip_hash.c and wall_hash.c, call by call, through the C# binding. Prints their two lines, and checks what else
// the binding offers: errors, lists, texts, snapshots, host hooks and every struct's size.
using System;
using System.Globalization;
using System.Runtime.InteropServices;
using Handhold;

internal static unsafe class Scenes {
    private static readonly Quat rotation = new Quat(0.70710678118654757, 0.0, 0.0, 0.70710678118654757);

    private static double Clamped(double x) => x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;

    private static TrackingSample DevicesAt(double time) {
        double swing = Clamped(time - 1.0) - 2.0 * Clamped(time - 1.5) + Clamped(2.0 * time - 4.5);
        TrackingSample sample = TrackingSample.Default();
        sample.time_s = time;
        sample.head.position.y = 1.6;
        sample.hands[0] = new HhPose(new Vec3(-0.2 - 0.4 * swing, 1.4, -0.43), rotation);
        sample.hands[1] = new HhPose(new Vec3(0.2, 1.4 - 0.3 * Clamped(time - 1.0), -0.43), rotation);
        sample.grab[0] = time >= 0.5;
        sample.grab[1] = time >= 0.5;
        return sample;
    }

    private static string GripScene() {
        using (World world = new World()) {
            BodyDef wall = BodyDef.Default();
            wall.shape = world.ShapeAddBox(new Vec3(1.0, 2.0, 0.1));
            wall.pose.position = new Vec3(0.95, 1.5, -0.6);
            world.BodyAdd(wall, "wall");
            Shape link = world.ShapeAddCapsule(0.03, 0.05);
            JointDef joint = JointDef.Default();
            for (int i = 0; i < 12; ++i) {
                BodyDef def = BodyDef.Default();
                def.kind = BodyKind.Dynamic;
                def.shape = link;
                def.mass_kg = 0.5;
                def.pose.position = new Vec3(-0.2, 1.4 + 0.125 * i, -0.52);
                joint.body_b = world.BodyAdd(def, "link" + i);
                if (i > 0) {
                    joint.kind = JointKind.Ball;
                    joint.frame.position = new Vec3(-0.2, 1.4 + 0.125 * i - 0.0625, -0.52);
                    world.JointAdd(joint);
                }
                joint.body_a = joint.body_b;
            }
            Shape box = world.ShapeAddBox(new Vec3(0.15, 0.1, 0.12));
            Shape hull = world.ShapeAddHull(new[] {
                new Vec3(0.0, 0.2, 0.0), new Vec3(0.2, -0.1, 0.0), new Vec3(-0.1, -0.1, 0.15), new Vec3(-0.1, -0.1, -0.15) });
            for (int i = 0; i < 20; ++i) {
                BodyDef def = BodyDef.Default();
                def.kind = BodyKind.Dynamic;
                def.shape = i % 2 == 0 ? box : hull;
                def.mass_kg = 1.0 + 0.25 * i;
                def.pose.position = new Vec3(0.3 * (i % 5) - 0.6, 0.5 + 0.35 * (i / 5), -1.5);
                def.velocity_mps = new Vec3(0.1 * (i % 3) - 0.1, 0.02 * i - 0.2, 0.3 - 0.03 * i);
                def.angular_velocity_radps = new Vec3(0.5, 0.1 * i, -0.3);
                world.BodyAdd(def, "crate" + i);
            }
            Player player = world.PlayerAdd(PlayerDef.Default(), "you");
            world.UseWrists(player);
            for (int frame = 1; frame <= 270; ++frame) {
                world.Step(1.0 / 90.0, player, new[] { DevicesAt(frame / 90.0) });
            }
            CheckRest(world, player);
            PlayerPose pose = world.PlayerPose(player);
            return string.Format("0x{0:x16} grips {1} {2}", world.Hash(), (int)pose.hands[0].grip, (int)pose.hands[1].grip);
        }
    }

    private static void Require(bool isRight, string what) {
        if (!isRight) {
            throw new Exception(what);
        }
    }

    // Nothing of this changes the world.
    private static void CheckRest(World world, Player player) {
        ulong before = world.Hash();
        byte[] saved = world.Save();
        world.Step(1.0 / 90.0, player, null);
        world.Restore(saved);
        Require(world.Hash() == before, "a snapshot goes back");
        Body wall = world.BodyFind("wall");
        Require(world.BodyName(wall) == "wall" && world.BodyIsValid(wall) && world.Bodies().Length == 33, "names and lists");
        HhPose[] poses = world.BodyPoses(new[] { wall, world.BodyFind("link11") });
        Require(poses[0].position.x == 0.95, "poses of many bodies");
        Hit hit = world.CastRay(new Vec3(0.95, 1.5, 5.0), new Vec3(0.95, 1.5, -5.0), player);
        Require(hit.body == wall && Math.Abs(hit.point.z + 0.5) < 1e-9, "a ray finds the wall");
        HandJoint[] joints = world.PlayerHandJoints(player, Side.Right, HhSpace.World);
        Require(joints.Length == Constants.HandJointCount && joints[(int)HandJointName.IndexTip].is_valid, "joints of a hand");
        Require(world.PlayerBodyJoints(player, HhSpace.World).Length == 20 && Library.BodyJointName(0) == "hips", "joints of the body");
        world.SetTuning("hand.reach_m", world.GetTuning("hand.reach_m", 1));
        Require(world.GetStats().bodies == 33, "statistics");
        try {
            world.ShapeAddSphere(-1.0);
            Require(false, "a negative radius is refused");
        } catch (HandholdException error) {
            Require(error.Result == Result.ErrorValue && error.Message.Length > 20, "errors have texts");
        }
        try {
            world.ShapeAddHull(new Vec3[0]);
            Require(false, "an empty hull is refused");
        } catch (HandholdException error) {
            Require(error.Result == Result.ErrorValue && error.Message.Contains("no points"), "an empty array is not null: " + error.Message);
        }
        Require(world.Hash() == before, "reading changes nothing");
    }

    private const double wallZ = -0.5;
    private const double step = 1.0 / 90.0;

    // The host's only surface.
    private sealed class Plane : ISurfaces {
        public Body Wall;
        private bool At(double x, double y, double distance, out SurfaceHit hit) {
            hit = new SurfaceHit { body = Wall, point = new Vec3(x, y, wallZ), normal = new Vec3(0.0, 0.0, 1.0), distance_m = distance };
            return true;
        }
        public bool CastRay(Vec3 from, Vec3 to, SkippedBodies skip, out SurfaceHit hit) {
            hit = default(SurfaceHit);
            if (skip.Contains(Wall) || from.z < wallZ || to.z >= wallZ) {
                return false;
            }
            double part = (from.z - wallZ) / (from.z - to.z);
            return At(from.x + part * (to.x - from.x), from.y + part * (to.y - from.y), 0.0, out hit);
        }
        public bool CastSphere(double radius, Vec3 from, Vec3 to, SkippedBodies skip, out SurfaceHit hit) {
            hit = default(SurfaceHit);
            return false;
        }
        public bool ClosestPoint(Vec3 point, double max, SkippedBodies skip, out SurfaceHit hit) {
            hit = default(SurfaceHit);
            double distance = point.z < wallZ ? 0.0 : point.z - wallZ;
            return !skip.Contains(Wall) && distance <= max && At(point.x, point.y, distance, out hit);
        }
        public bool ClosestPointOn(Body body, Vec3 point, out SurfaceHit hit) {
            hit = default(SurfaceHit);
            return body == Wall && ClosestPoint(point, 1e9, default(SkippedBodies), out hit);
        }
    }

    private static string WallScene() {
        using (World world = new World()) {
            Plane plane = new Plane();
            world.SetSurfaces(plane);
            BodyDef wall = BodyDef.Default();
            wall.pose.position = new Vec3(0.0, 1.5, wallZ);
            plane.Wall = world.BodyAdd(wall, "wall");
            Player player = world.PlayerAdd(PlayerDef.Default(), "you");
            world.UseWrists(player);
            int grabs = 0;
            for (int frame = 1; frame <= 180; ++frame) {
                TrackingSample sample = TrackingSample.Default();
                sample.time_s = frame / 90.0;
                sample.head.position.y = 1.6;
                sample.hands[0] = new HhPose(new Vec3(-0.2, 1.4, -0.43), rotation);
                sample.hands[1] = new HhPose(new Vec3(0.2, 1.4, -0.43 + 0.2 * Clamped(2.0 * (sample.time_s - 1.0))), rotation);
                sample.grab[1] = sample.time_s >= 0.5;
                world.BeginStep(step, player, new[] { sample });
                PlayerMotion motion = world.PlayerMotions()[0];
                Vec3 start = motion.origin;
                Vec3 speed = motion.velocity_mps;
                Vec3 end = new Vec3(start.x + step * speed.x, start.y + step * speed.y, start.z + step * speed.z);
                foreach (HandConstraint hand in world.HandConstraints()) {
                    end.x = hand.anchor_end.position.x - hand.target.position.x;
                    end.y = hand.anchor_end.position.y - hand.target.position.y;
                    end.z = hand.anchor_end.position.z - hand.target.position.z;
                }
                SolvedPlayer solved = new SolvedPlayer { player = player, origin = end };
                solved.velocity_mps = new Vec3((end.x - start.x) / step, (end.y - start.y) / step, (end.z - start.z) / step);
                world.EndStep(new[] { solved });
                foreach (HhEvent one in world.Events()) {
                    grabs += one.kind == EventKind.Grabbed ? 1 : 0;
                }
                GC.Collect(0);
            }
            double moved = -1000.0 * world.PlayerPose(player).origin.position.z;
            return string.Format(CultureInfo.InvariantCulture, "0x{0:x16} grabs {1} moved_mm {2:0.000}", world.Hash(), grabs, moved);
        }
    }

    private static int logged;

    private static int Main() {
        Library.SetLog((level, text) => ++logged);
        uint major, minor, patch;
        Library.Version(out major, out minor, out patch);
        Require(major == Constants.HandholdVersionMajor && minor == Constants.HandholdVersionMinor, "the library has the headers' version");
        Console.WriteLine(GripScene());
        Console.WriteLine(WallScene());
        Require(logged > 0, "the host's log hears the refused call");
        return 0;
    }
}
