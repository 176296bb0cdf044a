// The Unity package with stand-ins of Unity's types: its sample, in which a hand grips the wall ahead (+Z) and pulls the rig 0.2 m towards it, and what
// its components make of colliders.
using System;
using System.Reflection;
using Handhold;
using UnityEngine;

internal static class UnityScene {
    private static void Require(bool isRight, string what) {
        if (!isRight) {
            throw new Exception(what);
        }
    }
    private static Transform Below(Transform parent, Vector3 position) {
        Transform made = new GameObject("").transform;
        made.parent = parent;
        made.localPosition = position;
        return made;
    }

    // As Unity's XR Origin in Device mode: the devices are children of an object 1.36 m above the rig.
    private static void HandsPullTheRig() {
        const float offset = 1.36f;
        GripAWall scene = new GameObject("Scene").AddComponent<GripAWall>();
        scene.rig = new GameObject("Rig").transform;
        Transform above = Below(scene.rig, new Vector3(0.0f, offset, 0.0f));
        scene.head = Below(above, new Vector3(0.0f, 1.6f - offset, 0.0f));
        scene.controllers = new[] { Below(above, new Vector3(-0.2f, 1.4f - offset, 0.43f)), Below(above, new Vector3(0.2f, 1.4f - offset, 0.43f)) };
        foreach (Transform hand in scene.controllers) {
            // Palms face the wall: the wrist's fingers point up. Unity's rotation by -90 degrees about X.
            hand.localRotation = new Quaternion(-0.70710678f, 0.0f, 0.0f, 0.70710678f);
        }
        GameObject.Send(scene, "Start");
        HandholdPlayer player = (HandholdPlayer)typeof(GripAWall).GetField("player", BindingFlags.Instance | BindingFlags.NonPublic).GetValue(scene);
        player.shownHands[0] = new GameObject("Shown").transform;
        player.world.World.UseWrists(player.Id);
        int grabs = 0;
        player.world.Happened += one => grabs += one.kind == EventKind.Grabbed ? 1 : 0;
        for (int frame = 1; frame <= 180; ++frame) {
            float pulled = 0.4f * Math.Min(Math.Max(frame / 90.0f - 1.0f, 0.0f), 0.5f);
            scene.controllers[1].localPosition = new Vector3(0.2f, 1.4f - offset, 0.43f - pulled);
            scene.SetGrab(1, frame >= 45);
            GameObject.Send(player.world, "FixedUpdate");
            GameObject.Send(player.world, "Update");
        }
        Vector3 drawn = player.shownHands[0].position - scene.controllers[0].position;
        Require(Math.Abs(drawn.x) < 0.02f && Math.Abs(drawn.y) < 0.02f && Math.Abs(drawn.z) < 0.02f, "the free hand is drawn where its controller is");
        Require(player.world.World.PlayerHand(player.Id, Side.Right).grip == GripKind.Surface && grabs == 1, "the right hand grips");
        Console.WriteLine("the rig came to z = " + scene.rig.position.z);
        Require(Math.Abs(scene.rig.position.z - 0.2f) < 1e-4f, "the rig moves with the hand");
        double before, paused;
        ulong frames;
        player.world.World.Time(out before, out frames);
        Time.deltaTime = 0.0f;
        GameObject.Send(player.world, "Update");
        Time.deltaTime = 1.0f / 90.0f;
        player.world.World.Time(out paused, out frames);
        Require(before == paused, "a time scale of 0 stops the clock");
        player.inferred[1] = true;
        scene.controllers[1].localPosition = new Vector3(0.2f, 1.4f - offset, 0.0f);
        player.world.Step(1.0 / 90.0);
        Require(Math.Abs(scene.rig.position.z - 0.2f) < 1e-2f, "a guessed hand pulls nobody");
        player.gameObject.SetActive(false);
        GameObject.Send(player.world, "OnDestroy");
    }

    // A script that adds a component before it sets the fields.
    private static void ComponentsWithoutAWorldSayWhatTheyNeed<T>(Action<T> set) where T : Component, new() {
        GameObject made = new GameObject("Early");
        made.SetActive(false);
        set(made.AddComponent<T>());
        try {
            made.SetActive(true);
            Require(false, "a component without a world is refused");
        } catch (InvalidOperationException) {
        }
        made.Destroy();
    }

    private static HandholdBody Add<T>(HandholdWorld world, Vector3 scale, Action<T> set, BodyKind kind = BodyKind.Static) where T : Collider, new() {
        GameObject made = new GameObject("Body");
        made.SetActive(false);
        made.transform.localScale = scale;
        set(made.AddComponent<T>());
        HandholdBody body = made.AddComponent<HandholdBody>();
        body.world = world;
        body.kind = kind;
        made.SetActive(true);
        return body;
    }
    // Where a ray along an axis from far away meets the only body.
    private static double Extent(HandholdWorld world, Vec3 from) {
        Vec3 at = world.World.CastRay(from, new Vec3(0.0, 0.0, 0.0), default(Player)).point;
        return Math.Sqrt(at.x * at.x + at.y * at.y + at.z * at.z);
    }
    private static void RequireExtents(HandholdWorld world, HandholdBody body, double x, double y, double z, string what) {
        Require(Math.Abs(Extent(world, new Vec3(9.0, 1e-3, 2e-3)) - x) < 0.01 && Math.Abs(Extent(world, new Vec3(1e-3, 9.0, 2e-3)) - y) < 0.01 &&
                Math.Abs(Extent(world, new Vec3(1e-3, 2e-3, 9.0)) - z) < 0.01, what);
        body.gameObject.SetActive(false);
        body.gameObject.SetActive(true);
        Require(world.World.ShapeCount() == 1, what + ": switched on again it has the same shape");
        body.gameObject.Destroy();
        Require(world.World.ShapeCount() == 0 && world.World.Bodies().Length == 0, what + ": nothing stays behind");
    }
    private static Mesh Tetrahedron() => new Mesh {
        vertices = new[] { new Vector3(-1, -1, -1), new Vector3(3, -1, -1), new Vector3(-1, 3, -1), new Vector3(-1, -1, 3) },
        triangles = new[] { 0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3 } };

    // Six times the volume, by the divergence theorem: negative if the triangles face inwards.
    private static double Volume(Vector3 scale) {
        uint[] indices;
        float[] at = HandholdBody.Converted(Tetrahedron(), scale, out indices);
        double sum = 0.0;
        for (int i = 0; i < indices.Length; i += 3) {
            uint a = 3 * indices[i], b = 3 * indices[i + 1], c = 3 * indices[i + 2];
            sum += at[a] * (at[b + 1] * at[c + 2] - at[b + 2] * at[c + 1]) + at[a + 1] * (at[b + 2] * at[c] - at[b] * at[c + 2]) +
                   at[a + 2] * (at[b] * at[c + 1] - at[b + 1] * at[c]);
        }
        return sum;
    }
    private static void ShapesAreThoseOfTheColliders() {
        HandholdWorld world = new GameObject("World").AddComponent<HandholdWorld>();
        Vector3 scale = new Vector3(-0.2f, 0.4f, 0.1f);
        RequireExtents(world, Add<BoxCollider>(world, scale, made => { }), 0.1, 0.2, 0.05, "box");
        RequireExtents(world, Add<SphereCollider>(world, scale, made => { }), 0.2, 0.2, 0.2, "a sphere takes the largest scale");
        RequireExtents(world, Add<CapsuleCollider>(world, scale, made => { }), 0.1, 0.4, 0.1, "capsule");
        RequireExtents(world, Add<MeshCollider>(world, new Vector3(1, 1, 1), made => { made.sharedMesh = Tetrahedron(); made.convex = true; }, BodyKind.Kinematic),
                       1.0, 1.0, 1.0, "a convex mesh");
        Require(Volume(new Vector3(1, 1, 1)) == 64.0 && Volume(new Vector3(-1, 1, 2)) == 128.0, "meshes face outwards, mirrored ones too");
        try {
            Add<MeshCollider>(world, scale, made => { made.sharedMesh = Tetrahedron(); made.sharedMesh.isReadable = false; });
            Require(false, "a mesh without vertices is refused");
        } catch (NotSupportedException) {
        }
        Debug.Errors.Clear();
        try {
            world.World.ShapeAddSphere(-1.0);
        } catch (HandholdException) {
        }
        Require(Debug.Errors.Count > 0, "Unity's console shows the library's log");
        GameObject.Send(world, "OnDestroy");
    }

    private static int Main() {
        using (new World()) {
            HandsPullTheRig();
        }
        ShapesAreThoseOfTheColliders();
        ComponentsWithoutAWorldSayWhatTheyNeed<HandholdBody>(body => { });
        ComponentsWithoutAWorldSayWhatTheyNeed<HandholdPlayer>(player => player.controllers = null);
        return 0;
    }
}
