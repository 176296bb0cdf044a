// Matches in the C# binding: a server and two players over a queue that loses packets, state of the host's own, and misuse.
using System;
using System.Collections.Generic;
using Handhold;

internal static class Matches {
    private const double tick = 1.0 / 90.0;
    private const int seats = 2;
    private const int toServer = seats;

    private static void Require(bool isRight, string what) {
        if (!isRight) {
            throw new Exception(what);
        }
    }
    private static void RequireRefused(Result result, string text, Action work) {
        try {
            work();
        } catch (HandholdException error) {
            Require(error.Result == result && error.Message.Contains(text), text + " is named, not: " + error.Message);
            return;
        }
        Require(false, text + " is refused");
    }

    // Counts grips and pressed buttons.
    private sealed class Score : IMatchGame {
        public World World;
        public Action<ulong> InStep = now => { };
        public bool Forgets;
        public ulong Grips, Presses, Last;
        public int Restored, Again;
        private readonly ulong[] grips = new ulong[Constants.MatchPlaces], presses = new ulong[Constants.MatchPlaces];

        public void Step(ulong now, uint[] buttons) {
            Again += now <= Last ? 1 : 0;
            Last = now;
            foreach (HhEvent one in World.Events()) {
                Grips += one.kind == EventKind.Grabbed ? 1UL : 0UL;
            }
            foreach (uint pressed in buttons) {
                Presses += pressed != 0 ? 1UL : 0UL;
            }
            InStep(now);
        }
        public void Save(int place) {
            grips[place] = Grips;
            presses[place] = Presses;
        }
        public void Restore(int place) {
            if (!Forgets) {
                Restored += Grips != grips[place] || Presses != presses[place] ? 1 : 0;
                Grips = grips[place];
                Presses = presses[place];
            }
        }
        public ulong Hash() => 31 * Grips + Presses;
    }

    // The same level and players on every machine.
    private sealed class Machine : IDisposable {
        public readonly World World = new World();
        public readonly Player[] Players = new Player[seats];
        public readonly Score Score = new Score();
        public readonly Match Match;

        public Machine(MatchRole role, uint slot = 0) {
            BodyDef wall = BodyDef.Default();
            wall.shape = World.ShapeAddBox(new Vec3(4.0, 2.0, 0.1));
            wall.pose.position = new Vec3(0.0, 1.5, -0.6);
            World.BodyAdd(wall);
            for (int seat = 0; seat < seats; ++seat) {
                PlayerDef player = PlayerDef.Default();
                player.origin.position.x = 1.5 * seat;
                Players[seat] = World.PlayerAdd(player);
                World.UseWrists(Players[seat]);
            }
            Score.World = World;
            MatchDef def = MatchDef.Default();
            def.role = role;
            def.slot = slot;
            Match = new Match(World, Players, def, Score);
        }
        public void Dispose() {
            Match.Dispose();
            World.Dispose();
        }
    }

    // Hands that wave before the wall and close now and then.
    private static TrackingSample Devices(int seat, double time) {
        TrackingSample sample = TrackingSample.Default();
        sample.time_s = time;
        sample.head.position.y = 1.6;
        for (int side = 0; side < 2; ++side) {
            double x = side == 0 ? -0.2 : 0.2;
            sample.hands[side] = new HhPose(new Vec3(x + 0.05 * Math.Sin(2.0 * time + seat), 1.4, -0.43), new Quat(Math.Sqrt(0.5), 0.0, 0.0, Math.Sqrt(0.5)));
            sample.grab[side] = (time + 0.3 * seat + 0.5 * x) % 1.1 > 0.5;
        }
        return sample;
    }

    private struct Sent {
        public int Arrives, From, To;
        public byte[] Bytes;
    }
    // Every packet takes five ticks, and one of twelve is lost.
    private sealed class LossyQueue {
        public readonly Queue<Sent> Packets = new Queue<Sent>();
        private int sent;
        public void Send(int from, int to, int frame, byte[] bytes) {
            Require(bytes.Length > 0 && bytes.Length <= Constants.MatchPacketBytes, "packets have their own length");
            if (++sent % 12 != 0) {
                Packets.Enqueue(new Sent { Arrives = frame + 5, From = from, To = to, Bytes = bytes });
            }
        }
    }

    private static void WorldsOverALossyQueueAreEqual() {
        using (Machine server = new Machine(MatchRole.Server))
        using (Machine first = new Machine(MatchRole.Client, 0))
        using (Machine second = new Machine(MatchRole.Client, 1))
        using (Machine watcher = new Machine(MatchRole.Spectator)) {
            Machine[] clients = { first, second };
            LossyQueue queue = new LossyQueue();
            Dictionary<ulong, ulong> hashes = new Dictionary<ulong, ulong>();
            int compared = 0, watched = 0, predicted = 0, confirmed = 0;
            ulong told = 0;
            double drawn = 0.0;
            server.Match.Connect(0);
            server.Match.Connect(1);
            for (int frame = 1; frame <= 300; ++frame) {
                double now = frame * tick;
                for (; queue.Packets.Count > 0 && queue.Packets.Peek().Arrives <= frame; queue.Packets.Dequeue()) {
                    Sent packet = queue.Packets.Peek();
                    if (packet.To == toServer) {
                        server.Match.ReceiveFrom((uint)packet.From, now, packet.Bytes);
                    } else {
                        clients[packet.To].Match.Receive(packet.Bytes);
                    }
                }
                server.Match.Confirm(now);
                ulong present = server.Match.GetStats().tick;
                hashes[present] = server.Match.Hash(present);
                for (int seat = 0; seat < seats; ++seat) {
                    Machine own = clients[seat];
                    queue.Send(toServer, seat, frame, server.Match.PacketTo((uint)seat));
                    for (uint left = own.Match.TicksDue(tick); left > 0; --left) {
                        double time;
                        ulong count;
                        own.World.Time(out time, out count);
                        own.Match.Advance(new[] { Devices(seat, time + tick) }, frame % 50 == 0 ? 1U : 0U, default(Commands), left > 1);
                        foreach (MatchEvent one in own.Match.Events()) {
                            bool isGrip = one.@event.kind == EventKind.Grabbed;
                            predicted += isGrip && one.state == MatchEventState.Predicted ? 1 : 0;
                            confirmed += isGrip && one.state == MatchEventState.Confirmed ? 1 : 0;
                        }
                    }
                    queue.Send(seat, toServer, frame, own.Match.Packet());
                    MatchStats stats = own.Match.GetStats();
                    if (hashes.ContainsKey(stats.confirmed) && stats.confirmed + (ulong)Constants.MatchPlaces > stats.tick) {
                        Require(own.Match.Hash(stats.confirmed) == hashes[stats.confirmed], "tick " + stats.confirmed + " is equal");
                        ++compared;
                    }
                    HhPose origin, head, left_, right_;
                    own.Match.DrawnPlayer((uint)(1 - seat), null, out origin, out head, out left_, out right_);
                    own.Match.DrawnPlayer((uint)seat, Devices(seat, now), out origin, out head, out left_, out right_);
                    drawn = Math.Max(drawn, origin.position.x);
                }
                if (frame == 100) {
                    watcher.Match.Join(server.Match.State(Constants.MatchNoSlot));
                    watcher.Score.Grips = server.Score.Grips;
                    watcher.Score.Presses = server.Score.Presses;
                    told = present;
                } else if (frame > 100) {
                    byte[] inputs;
                    server.Match.ConfirmedInputs(told, out inputs, out told);
                    watcher.Match.Receive(inputs);
                    while (watcher.Match.Advance(null)) {
                        ulong at = watcher.Match.GetStats().tick;
                        Require(!hashes.ContainsKey(at) || watcher.Match.Hash(at) == hashes[at], "who watches sees the same");
                        ++watched;
                    }
                }
                GC.Collect(0);
            }
            Require(compared > 300 && watched > 150, "compared " + compared + " and " + watched);
            foreach (Machine own in clients) {
                Require(own.Match.GetStats().rollbacks > 50 && own.Score.Restored > 0 && own.Score.Again > 50, "scores go back with the world");
            }
            Require(server.Score.Restored == 0 && server.Score.Grips > 4 && server.Score.Presses > 4, "grips and buttons are counted");
            Require(confirmed > 4 && predicted >= confirmed, "events come twice");
            Require(Math.Abs(drawn - 1.5) < 0.5 && first.Match.DrawnBodies(first.World.Bodies())[0].position.z == -0.6, "poses are drawn");
            Require(!server.Match.NeedsState(0) && server.Match.GetStats().out_of_sync == 0, "nobody is out of sync");
            Console.WriteLine("match: {0} ticks equal, {1} watched, {2} grips, {3} rollbacks", compared, watched, server.Score.Grips, first.Match.GetStats().rollbacks);
        }
    }

    private static void AWorldOutlivesItsMatch() {
        using (Machine own = new Machine(MatchRole.Client)) {
            RequireRefused(Result.ErrorState, "in a match", () => own.World.Step(tick, own.Players[0], null));
            RequireRefused(Result.ErrorState, "in a match", () => new Match(own.World, own.Players, MatchDef.Default()));
            RequireRefused(Result.ErrorState, "in a match", () => own.World.Step(tick, own.Players[0], null));
            own.Match.Dispose();
            own.Match.Dispose();
            own.World.Step(tick, own.Players[0], null);
            RequireRefused(Result.ErrorNull, "match", () => own.Match.Advance(null));
            new Match(own.World, own.Players, MatchDef.Default()).Dispose();
        }
    }
    private static void ADisposedWorldEndsItsMatch() {
        Machine own = new Machine(MatchRole.Client);
        try {
            using (own.World) {
                own.Match.Advance(null);
                throw new FormatException("the reason, not a match that is still open");
            }
        } catch (FormatException) {
        }
        RequireRefused(Result.ErrorNull, "match", () => own.Match.Advance(null));
        own.Dispose();
    }
    private static void WhatAMatchNeedsIsNamed() {
        RequireRefused(Result.ErrorNull, "world", () => new Match(null, new Player[1], MatchDef.Default()));
        using (Machine own = new Machine(MatchRole.Client)) {
            RequireRefused(Result.ErrorState, "server", () => own.Match.Confirm(0.0));
            RequireRefused(Result.ErrorData, "packet", () => own.Match.Receive(new byte[] { 1, 2 }));
            RequireRefused(Result.ErrorValue, "slot", () => own.Match.NeedsState(9));
            own.Match.Dispose();
            RequireRefused(Result.ErrorValue, "no players", () => new Match(own.World, null, MatchDef.Default()));
            RequireRefused(Result.ErrorValue, "no players", () => new Match(own.World, new Player[0], MatchDef.Default()));
            RequireRefused(Result.ErrorVersion, "", () => new Match(own.World, own.Players, default(MatchDef)));
            MatchDef def = MatchDef.Default();
            def.tick_s = 90.0;
            RequireRefused(Result.ErrorValue, "tick_s", () => new Match(own.World, own.Players, def));
        }
    }
    private static void WhatAGameThrowsReachesTheCall() {
        using (Machine own = new Machine(MatchRole.Client)) {
            own.Score.InStep = now => { throw new FormatException("no score"); };
            try {
                own.Match.Advance(null);
                Require(false, "an exception in a step is thrown");
            } catch (FormatException) {
            }
            own.Score.InStep = now => own.Match.Dispose();
            RequireRefused(Result.ErrorState, "a match cannot be disposed inside a callback", () => own.Match.Advance(null));
            own.Score.InStep = now => own.World.Dispose();
            RequireRefused(Result.ErrorState, "a world cannot be disposed inside a callback", () => own.Match.Advance(null));
            own.Score.InStep = now => own.Match.GetStats();
            RequireRefused(Result.ErrorState, "game is running", () => own.Match.Advance(null));
            own.Score.InStep = now => { };
            Require(own.Match.Advance(null), "the match goes on");
        }
    }
    private static void TheSyncTestNamesWhatIsForgotten() {
        foreach (bool forgets in new[] { false, true }) {
            using (Machine own = new Machine(MatchRole.SyncTest)) {
                own.Score.Forgets = forgets;
                MatchDifference found = default(MatchDifference);
                for (int frame = 1; frame < 60 && found.tick == 0; ++frame) {
                    found = own.Match.SyncTest(new[] { Devices(0, frame * tick), Devices(1, frame * tick) }, new[] { 1U, 0U });
                }
                Require((found.tick != 0) == forgets && found.in_game == forgets && !found.in_world, "a sync test finds a game that forgets");
            }
        }
    }
    private static WeakReference Dropped() => new WeakReference(new Machine(MatchRole.Client).World);
    private static void MatchesWithoutAnOwnerAreFinalizedWithTheirWorlds() {
        WeakReference[] worlds = new WeakReference[10];
        for (int i = 0; i < worlds.Length; ++i) {
            worlds[i] = Dropped();
        }
        GC.Collect();
        GC.WaitForPendingFinalizers();
        GC.Collect();
        // A conservative stack may still hold a few.
        Require(Array.FindAll(worlds, one => !one.IsAlive).Length > 5, "matches without an owner are finalized");
    }

    private static int Main() {
        int errors = 0;
        Library.SetLog((level, text) => errors += text.Contains("destroyed") ? 1 : 0);
        WorldsOverALossyQueueAreEqual();
        AWorldOutlivesItsMatch();
        ADisposedWorldEndsItsMatch();
        WhatAMatchNeedsIsNamed();
        WhatAGameThrowsReachesTheCall();
        TheSyncTestNamesWhatIsForgotten();
        MatchesWithoutAnOwnerAreFinalizedWithTheirWorlds();
        Require(errors == 0, "the library never refuses to destroy");
        Console.WriteLine("matches: right");
        return 0;
    }
}
