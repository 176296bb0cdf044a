using System;
using System.Collections.Generic;
using UnityEngine;

namespace Handhold {
    /// <summary>Owns a world and steps it: kinematic bodies first, then players, then all poses back into the scene. It runs after scripts of the
    /// default order, so it sees what they moved in the same frame.</summary>
    [DefaultExecutionOrder(100)]
    public sealed unsafe class HandholdWorld : MonoBehaviour {
        /// <summary>Read when the world is made: by the first component that is enabled.</summary>
        public Vector3 gravity = Vector3.zero;
        /// <summary>Off: one step a frame, which is what a headset needs. On: in FixedUpdate, for hosts whose own physics runs there. Set Unity's Fixed
        /// Timestep to the display's interval then, else the rig moves at another rate than the picture.</summary>
        public bool stepsInFixedUpdate;

        /// <summary>Every event of every step.</summary>
        public event Action<HhEvent> Happened;

        public World World => world ?? (world = Make());

        private static int worlds;
        private World world;
        private PlayerInput[] inputs = new PlayerInput[0];
        private Player[] ids = new Player[0];
        private readonly List<HandholdBody> bodies = new List<HandholdBody>();
        private readonly List<HandholdPlayer> players = new List<HandholdPlayer>();

        private World Make() {
            if (worlds == 0) {
                Hear(Log);
            }
            WorldDef def = WorldDef.Default();
            def.gravity_mps2 = UnityConvert.FromUnity(gravity);
            World made = new World(def);
            ++worlds;
            return made;
        }
        private static void Hear(Action<LogLevel, string> log) {
            try {
                Library.SetLog(log);
            } catch (HandholdException error) when (error.Result == Result.ErrorState) {
                // The script has a world of its own: hooks stay as they are.
            }
        }
        private static void Log(LogLevel level, string text) {
            if (level == LogLevel.Error) {
                Debug.LogError("Handhold: " + text);
            } else {
                Debug.Log("Handhold: " + text);
            }
        }
        private void OnDestroy() {
            if (world == null) {
                return;
            }
            world.Dispose();
            if (--worlds == 0) {
                Hear(null);
            }
        }

        internal void Add(HandholdBody body) { bodies.Add(body); }
        internal void Remove(HandholdBody body) { bodies.Remove(body); }
        internal void Add(HandholdPlayer player) { players.Add(player); }
        internal void Remove(HandholdPlayer player) { players.Remove(player); }

        private void Update() {
            if (!stepsInFixedUpdate) {
                Step(Time.deltaTime);
            }
        }
        private void FixedUpdate() {
            if (stepsInFixedUpdate) {
                Step(Time.fixedDeltaTime);
            }
        }

        /// <summary>One step. At a time scale of 0, only the shown players follow their devices.</summary>
        public void Step(double dt_s) {
            foreach (HandholdBody body in bodies) {
                body.BeforeStep();
            }
            double time;
            ulong frame;
            World.Time(out time, out frame);
            if (inputs.Length != players.Count) {
                inputs = new PlayerInput[players.Count];
                ids = new Player[players.Count];
            }
            TrackingSample* samples = stackalloc TrackingSample[players.Count];
            for (int i = 0; i < inputs.Length; ++i) {
                samples[i] = players[i].Sample(time + dt_s);
                ids[i] = players[i].Id;
                inputs[i] = World.InputOf(ids[i], samples + i, 1, players[i].commands);
            }
            if (dt_s > 0.0) {
                world.Step(dt_s, inputs);
            } else {
                world.StepPoseOnly(Math.Max(1e-3, Time.unscaledDeltaTime), inputs);
            }
            foreach (HandholdBody body in bodies) {
                body.AfterStep();
            }
            PlayerPose[] poses = world.PlayerPoses(ids);
            for (int i = 0; i < poses.Length; ++i) {
                players[i].AfterStep(poses[i]);
            }
            if (dt_s > 0.0 && Happened != null) {
                foreach (HhEvent one in world.Events()) {
                    Happened(one);
                }
            }
        }
    }
}
