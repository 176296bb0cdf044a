// Lifetimes in the C# binding: callbacks, objects that are disposed at a wrong time, arrays of a fixed length, a library that is not there.
using System;
using Handhold;

internal static class Lifetimes {
    private static void Require(bool isRight, string what) {
        if (!isRight) {
            throw new Exception(what);
        }
    }
    private static void RequireRefused(Result result, Action work, string what) {
        try {
            work();
        } catch (HandholdException error) {
            Require(error.Result == result, what + ": " + error.Message);
            return;
        }
        Require(false, what);
    }

    private sealed class Asked : ISurfaces {
        public Action Work;
        public int Count;
        private bool None(out SurfaceHit hit) {
            hit = default(SurfaceHit);
            ++Count;
            Work();
            return false;
        }
        public bool CastRay(Vec3 from, Vec3 to, SkippedBodies skip, out SurfaceHit hit) => None(out hit);
        public bool CastSphere(double radius, Vec3 from, Vec3 to, SkippedBodies skip, out SurfaceHit hit) => None(out hit);
        public bool ClosestPoint(Vec3 point, double max, SkippedBodies skip, out SurfaceHit hit) => None(out hit);
        public bool ClosestPointOn(Body body, Vec3 point, out SurfaceHit hit) => None(out hit);
    }
    private static void Step(World world, Player player) {
        double time;
        ulong frame;
        world.Time(out time, out frame);
        TrackingSample sample = TrackingSample.Default();
        sample.time_s = time + 1.0 / 90.0;
        sample.head = new HhPose(new Vec3(0.0, 1.6, 0.0));
        sample.hands[0] = new HhPose(new Vec3(-0.2, 1.4, -0.4));
        sample.hands[1] = new HhPose(new Vec3(0.2, 1.4, -0.4));
        world.Step(1.0 / 90.0, player, new[] { sample });
    }

    private static void QueriesOutliveCollectionsAndRefuseWhatEndsThem() {
        using (World world = new World()) {
            Player player = world.PlayerAdd(PlayerDef.Default(), "you");
            world.BodyAdd(BodyDef.Default(), "wall");
            Asked asked = new Asked { Work = GC.Collect };
            world.SetSurfaces(asked);
            Step(world, player);
            Require(asked.Count > 0, "a step asks");
            asked.Work = () => world.Dispose();
            RequireRefused(Result.ErrorState, () => Step(world, player), "a world is not disposed inside its own query");
            asked.Work = () => world.SetSurfaces(null);
            RequireRefused(Result.ErrorState, () => Step(world, player), "queries are not replaced inside a query");
            Require(world.Surfaces == asked, "refused calls change nothing");
            asked.Work = () => { throw new FormatException("no level"); };
            try {
                Step(world, player);
                Require(false, "what a query throws is thrown by the step");
            } catch (FormatException) {
            }
            asked.Work = () => { };
            Step(world, player);
        }
    }
    private static WeakReference Dropped() {
        World world = new World();
        world.SetSurfaces(new Asked { Work = () => world.Hash() });
        return new WeakReference(world);
    }
    private static void SurfacesThatKnowTheirWorldDoNotKeepIt() {
        WeakReference[] worlds = new WeakReference[20];
        for (int i = 0; i < worlds.Length; ++i) {
            worlds[i] = Dropped();
        }
        GC.Collect();
        GC.WaitForPendingFinalizers();
        // A conservative stack may still hold a few.
        Require(Array.FindAll(worlds, one => !one.IsAlive).Length > 10, "worlds without an owner are finalized");
    }
    private static void FingersNeedAllJointsOfAHand() {
        using (World world = new World()) {
            Player player = world.PlayerAdd(PlayerDef.Default(), "you");
            Step(world, player);
            HandJoint[] joints = world.PlayerHandJoints(player, Side.Right, HhSpace.World);
            FingerCurls curls = Library.FingerCurlsOf(joints);
            for (int finger = 0; finger < 5; ++finger) {
                Require(curls.fingers[finger] >= 0.0 && curls.fingers[finger] < 0.6, "an open hand");
            }
            foreach (HandJoint[] wrong in new[] { null, new HandJoint[1], new HandJoint[27] }) {
                try {
                    Library.FingerCurlsOf(wrong);
                    Require(false, "another number of joints is refused");
                } catch (ArgumentException) {
                }
            }
        }
    }
    // A T-pose of 1.7 m, with names that only their texts tell.
    private static void NamesOfASkeletonArrive() {
        string[] names = { "Hips", "Spine", "Head", "LeftUpperArm", "LeftLowerArm", "LeftHand", "RightUpperArm", "RightLowerArm", "RightHand",
                           "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightUpperLeg", "RightLowerLeg", "RightFoot", null };
        int[] parents = { -1, 0, 1, 1, 3, 4, 1, 6, 7, 0, 9, 10, 0, 12, 13, 2 };
        double[,] places = { { 0, 0.95, 0 }, { 0, 1.1, 0 }, { 0, 1.5, 0 }, { -0.18, 1.4, 0 }, { -0.46, 1.4, 0.01 }, { -0.71, 1.4, 0 },
                             { 0.18, 1.4, 0 }, { 0.46, 1.4, 0.01 }, { 0.71, 1.4, 0 }, { -0.09, 0.9, 0 }, { -0.09, 0.5, -0.01 }, { -0.09, 0.08, 0 },
                             { 0.09, 0.9, 0 }, { 0.09, 0.5, -0.01 }, { 0.09, 0.08, 0 }, { 0, 1.7, 0 } };
        SkeletonJoint[] joints = new SkeletonJoint[names.Length];
        for (int i = 0; i < joints.Length; ++i) {
            joints[i].parent = parents[i];
            joints[i].bind.position = new Vec3(places[i, 0], places[i, 1], places[i, 2]);
            joints[i].bind.rotation = new Quat(0.0, 0.0, 0.0, 1.0);
        }
        using (World world = new World()) {
            Player player = world.PlayerAdd(PlayerDef.Default(), "you");
            world.PlayerSetBodySkeleton(player, joints, HhSpace.World, names);
            GC.Collect();
            for (int i = 0; i < joints.Length; ++i) {
                string name;
                int parent;
                world.PlayerSkeletonJoint(player, i, out name, out parent);
                Require((name ?? "") == (names[i] ?? "") && parent == parents[i], "joint " + i + " is " + name);
            }
            try {
                world.PlayerSetBodySkeleton(player, joints, HhSpace.World, new[] { "Hips" });
                Require(false, "fewer names than joints are refused");
            } catch (ArgumentException) {
            }
        }
    }
    private static int logged;
    private static void SetLog() { Library.SetLog((level, text) => ++logged); }
    private static void TheLogOutlivesCollections() {
        SetLog();
        GC.Collect();
        using (World world = new World()) {
            RequireRefused(Result.ErrorValue, () => world.ShapeAddSphere(-1.0), "a negative radius");
            Require(logged == 1, "the log is heard");
            RequireRefused(Result.ErrorState, () => Library.SetLog(null), "hooks stay while a world exists");
            int before = logged;
            RequireRefused(Result.ErrorValue, () => world.ShapeAddSphere(-1.0), "a negative radius");
            Require(logged == before + 1, "refused hooks change nothing");
        }
        Library.SetLog(null);
    }
    private static void MakeWithoutLibrary() {
        foreach (Action make in new Action[] { () => new World(), () => new HhMesh(new float[9], new uint[3]) }) {
            try {
                make();
                Require(false, "there is no library");
            } catch (DllNotFoundException) {
            }
        }
    }

    private static int Main(string[] words) {
        if (words.Length > 0) {
            MakeWithoutLibrary();
            GC.Collect();
            GC.WaitForPendingFinalizers();
            Console.WriteLine("without a library: one exception, and the program lives");
            return 0;
        }
        FingersNeedAllJointsOfAHand();
        NamesOfASkeletonArrive();
        QueriesOutliveCollectionsAndRefuseWhatEndsThem();
        SurfacesThatKnowTheirWorldDoNotKeepIt();
        TheLogOutlivesCollections();
        Console.WriteLine("lifetimes: right");
        return 0;
    }
}
