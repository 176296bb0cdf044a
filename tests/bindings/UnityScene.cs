// The Unity package's sample, with stand-ins of Unity's types: a hand grips the wall ahead (+Z) and pulls the rig 0.2 m towards it.
using System;
using Handhold;
using UnityEngine;

internal static class UnityScene {
    private static Transform At(float x, float y, float z) {
        Transform made = new GameObject("").transform;
        made.localPosition = new Vector3(x, y, z);
        // Palms face the wall: the wrist's fingers point up. Unity's rotation by -90 degrees about X.
        made.localRotation = new Quaternion(-0.70710678f, 0.0f, 0.0f, 0.70710678f);
        return made;
    }
    private static int Main() {
        GameObject holder = new GameObject("Scene");
        GripAWall scene = holder.AddComponent<GripAWall>();
        scene.rig = new GameObject("Rig").transform;
        scene.head = At(0.0f, 1.6f, 0.0f);
        scene.controllers = new[] { At(-0.2f, 1.4f, 0.43f), At(0.2f, 1.4f, 0.43f) };
        GameObject.Send(scene, "Start");
        HandholdPlayer player = (HandholdPlayer)typeof(GripAWall).GetField("player", System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic).GetValue(scene);
        player.world.World.UseWrists(player.Id);
        for (int frame = 1; frame <= 180; ++frame) {
            float pulled = 0.4f * Math.Min(Math.Max(frame / 90.0f - 1.0f, 0.0f), 0.5f);
            scene.controllers[1].localPosition = new Vector3(0.2f, 1.4f, 0.43f - pulled);
            scene.SetGrab(1, frame >= 45);
            player.world.Step(1.0 / 90.0);
        }
        bool isRight = player.world.World.PlayerHand(player.Id, Side.Right).grip == GripKind.Surface && Math.Abs(scene.rig.position.z - 0.2f) < 1e-4f;
        Console.WriteLine("the rig came to z = " + scene.rig.position.z);
        GameObject.Send(player.world, "OnDestroy");
        return isRight ? 0 : 1;
    }
}
