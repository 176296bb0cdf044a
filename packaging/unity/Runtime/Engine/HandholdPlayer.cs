using System;
using UnityEngine;

namespace Handhold {
    /// <summary>A player. `rig` is the tracked space (XR Origin), with a scale of 1: it is placed where the player's origin is. `head` and `controllers` are
    /// anywhere below it, at the camera's and the grip poses. Set `grab` and the others from your input before the world steps.</summary>
    public sealed class HandholdPlayer : MonoBehaviour {
        public HandholdWorld world;
        public Transform rig;
        public Transform head;
        public Transform[] controllers = new Transform[2];
        /// <summary>The wrists to draw, by side; may be null.</summary>
        public Transform[] shownHands = new Transform[2];
        public bool[] grab = new bool[2];
        /// <summary>How far the grip button and the trigger are pressed, 0 to 1.</summary>
        public float[] squeeze = new float[2];
        public float[] trigger = new float[2];
        /// <summary>From InputTrackingState: false if the position is not there.</summary>
        public bool[] tracked = { true, true };
        /// <summary>True if the runtime only guesses the position: the hand then grips nothing and moves nobody.</summary>
        public bool[] inferred = new bool[2];
        public Commands commands;

        public Player Id { get; private set; }

        private void OnEnable() {
            if (world == null || rig == null || head == null || controllers == null || controllers.Length != 2 || controllers[0] == null || controllers[1] == null) {
                throw new InvalidOperationException(name + ": set world, rig, head and both controllers of HandholdPlayer before the component is enabled");
            }
            PlayerDef def = PlayerDef.Default();
            def.origin = UnityConvert.FromUnity(rig.position, rig.rotation);
            Id = world.World.PlayerAdd(def, null);
            world.Add(this);
        }
        private void OnDisable() {
            if (world == null) {  // never enabled, or the world is destroyed
                return;
            }
            world.Remove(this);
            if (world.World.PlayerIsValid(Id)) {
                world.World.PlayerRemove(Id);
            }
        }

        // Devices need not be direct children of the rig: XR Origin has a Camera Offset between.
        private HhPose InRig(Transform device) {
            Quaternion toRig = Quaternion.Inverse(rig.rotation);
            return UnityConvert.FromUnity(toRig * (device.position - rig.position), toRig * device.rotation);
        }
        internal TrackingSample Sample(double time_s) {
            TrackingSample sample = TrackingSample.Default();
            sample.time_s = time_s;
            sample.head = InRig(head);
            for (int side = 0; side < 2; ++side) {
                sample.hands[side] = InRig(controllers[side]);
                sample.hand_tracked[side] = tracked[side];
                sample.hand_inferred[side] = inferred[side];
                sample.grab[side] = grab[side];
                sample.squeeze[side] = squeeze[side];
                sample.trigger[side] = trigger[side];
            }
            return sample;
        }
        internal void AfterStep(PlayerPose pose) {
            rig.SetPositionAndRotation(UnityConvert.ToUnity(pose.origin.position), UnityConvert.ToUnity(pose.origin.rotation));
            for (int side = 0; side < 2; ++side) {
                if (shownHands[side] != null) {
                    HhPose shown = pose.hands[side].shown;
                    shownHands[side].SetPositionAndRotation(UnityConvert.ToUnity(shown.position), UnityConvert.ToUnity(shown.rotation));
                }
            }
        }
    }
}
