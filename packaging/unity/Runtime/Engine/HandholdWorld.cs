using System.Collections.Generic;
using UnityEngine;

namespace Handhold {
    /// <summary>Owns a world and steps it in FixedUpdate: kinematic bodies first, then players, then all poses back into the scene.</summary>
    [DefaultExecutionOrder(-100)]
    public sealed unsafe class HandholdWorld : MonoBehaviour {
        public Vector3 gravity = Vector3.zero;

        public World World { get; private set; }
        /// <summary>Events of the last step.</summary>
        public Event[] Events { get; private set; } = new Event[0];

        private readonly List<HandholdBody> bodies = new List<HandholdBody>();
        private readonly List<HandholdPlayer> players = new List<HandholdPlayer>();

        private void Awake() {
            WorldDef def = WorldDef.Default();
            def.gravity_mps2 = Convert.FromUnity(gravity);
            World = new World(def);
        }
        private void OnDestroy() { World.Dispose(); }

        internal void Add(HandholdBody body) { bodies.Add(body); }
        internal void Remove(HandholdBody body) { bodies.Remove(body); }
        internal void Add(HandholdPlayer player) { players.Add(player); }
        internal void Remove(HandholdPlayer player) { players.Remove(player); }

        private void FixedUpdate() { Step(Time.fixedDeltaTime); }

        /// <summary>One step. Called by FixedUpdate.</summary>
        public void Step(double dt_s) {
            foreach (HandholdBody body in bodies) {
                body.BeforeStep();
            }
            double time;
            ulong frame;
            World.Time(out time, out frame);
            TrackingSample* samples = stackalloc TrackingSample[players.Count];
            PlayerInput[] inputs = new PlayerInput[players.Count];
            for (int i = 0; i < inputs.Length; ++i) {
                samples[i] = players[i].Sample(time + dt_s);
                inputs[i] = World.InputOf(players[i].Id, samples + i, 1, players[i].commands);
            }
            World.Step(dt_s, inputs);
            Events = World.Events();
            foreach (HandholdBody body in bodies) {
                body.AfterStep();
            }
            foreach (HandholdPlayer player in players) {
                player.AfterStep();
            }
        }
    }
}
