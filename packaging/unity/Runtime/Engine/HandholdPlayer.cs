using UnityEngine;

namespace Handhold {
    /// <summary>A player. `rig` is the tracked space (XR Origin): it is placed where the player's origin is. `head` and the controllers are children
    /// of it, at the devices' grip poses. Set `grab` from your input each frame.</summary>
    public sealed class HandholdPlayer : MonoBehaviour {
        public HandholdWorld world;
        public Transform rig;
        public Transform head;
        public Transform[] controllers = new Transform[2];
        /// <summary>The wrists to draw, by side; may be null.</summary>
        public Transform[] shownHands = new Transform[2];
        public bool[] grab = new bool[2];
        public Commands commands;

        public Player Id { get; private set; }

        private void OnEnable() {
            PlayerDef def = PlayerDef.Default();
            def.origin = Convert.FromUnity(rig.position, rig.rotation);
            Id = world.World.PlayerAdd(def, null);
            world.Add(this);
        }
        private void OnDisable() {
            world.Remove(this);
            if (world.World.PlayerIsValid(Id)) {
                world.World.PlayerRemove(Id);
            }
        }

        internal TrackingSample Sample(double time_s) {
            TrackingSample sample = TrackingSample.Default();
            sample.time_s = time_s;
            sample.head = Convert.FromUnity(head.localPosition, head.localRotation);
            for (int side = 0; side < 2; ++side) {
                sample.hands[side] = Convert.FromUnity(controllers[side].localPosition, controllers[side].localRotation);
                sample.grab[side] = grab[side];
            }
            return sample;
        }
        internal void AfterStep() {
            PlayerPose pose = world.World.PlayerPose(Id);
            rig.SetPositionAndRotation(Convert.ToUnity(pose.origin.position), Convert.ToUnity(pose.origin.rotation));
            for (int side = 0; side < 2; ++side) {
                if (shownHands[side] != null) {
                    Pose shown = pose.hands[side].shown;
                    shownHands[side].SetPositionAndRotation(Convert.ToUnity(shown.position), Convert.ToUnity(shown.rotation));
                }
            }
        }
    }
}
