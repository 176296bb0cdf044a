using Handhold;
using UnityEngine;

/// <summary>Put it on an empty object. It makes a wall and a crate; assign the rig, the head and both controllers of your XR Origin, and call
/// SetGrab from your input.</summary>
public sealed class GripAWall : MonoBehaviour {
    public Transform rig;
    public Transform head;
    public Transform[] controllers = new Transform[2];
    private HandholdPlayer player;

    private void Start() {
        GameObject root = new GameObject("Handhold");
        HandholdWorld world = root.AddComponent<HandholdWorld>();
        AddBox(world, new Vector3(0.0f, 1.5f, 0.6f), new Vector3(4.0f, 4.0f, 0.2f), BodyKind.Static);
        AddBox(world, new Vector3(0.4f, 1.2f, 0.4f), new Vector3(0.2f, 0.2f, 0.2f), BodyKind.Dynamic);
        GameObject holder = new GameObject("Player");
        holder.SetActive(false);  // until its fields are set
        player = holder.AddComponent<HandholdPlayer>();
        player.world = world;
        player.rig = rig;
        player.head = head;
        player.controllers = controllers;
        holder.SetActive(true);
    }
    public void SetGrab(int side, bool isDown) { player.grab[side] = isDown; }

    private static void AddBox(HandholdWorld world, Vector3 position, Vector3 size, BodyKind kind) {
        GameObject box = GameObject.CreatePrimitive(PrimitiveType.Cube);
        box.SetActive(false);
        box.transform.position = position;
        box.transform.localScale = size;
        HandholdBody body = box.AddComponent<HandholdBody>();
        body.world = world;
        body.kind = kind;
        body.mass = 5.0f;
        box.SetActive(true);
    }
}
