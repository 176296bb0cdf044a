"""Matches in the Python binding: a server and two players over a queue that loses packets, state of the host's own, and misuse."""
import copy
import gc
import math
import unittest
import weakref

import handhold as hh

TICK_S = 1.0 / 90.0
SEATS = 2
SERVER = SEATS


class Score:
    """Counts grips and pressed buttons. `restored`: how often the match took the count back."""

    def __init__(self):
        self.world = None
        self.grips = self.presses = self.restored = self.again = self.last = 0
        self.kept = [(0, 0)] * hh.HH_MATCH_PLACES

    def step(self, tick, buttons):
        self.again += tick <= self.last
        self.last = tick
        self.grips += sum(int(event["kind"]) == hh.HH_EVENT_GRABBED for event in self.world.events())
        self.presses += sum(pressed != 0 for pressed in buttons)

    def save(self, place):
        self.kept[place] = (self.grips, self.presses)

    def restore(self, place):
        self.restored += (self.grips, self.presses) != self.kept[place]
        self.grips, self.presses = self.kept[place]

    def hash(self):
        return 31 * self.grips + self.presses


def level():
    """The same on every machine."""
    world = hh.World()
    world.body_add(shape=world.shape_add_box((4.0, 2.0, 0.1)), pose=((0.0, 1.5, -0.6),))
    players = [world.player_add(origin=((1.5 * seat, 0.0, 0.0),)) for seat in range(SEATS)]
    for player in players:
        world.use_wrists(player)
    return world, players


class Machine:
    def __init__(self, role, slot=0, game=None, **fields):
        self.world, self.players = level()
        self.game = game or Score()
        self.game.world = self.world
        self.match = hh.Match(self.world, self.game, role=role, slot=slot, players=self.players, **fields)

    def close(self):
        self.match.close()
        self.world.close()


def devices(seat, time_s):
    """Hands that wave before the wall and close now and then."""
    sides = [-0.2, 0.2]
    palm_ahead = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    hands = [((x + 0.05 * math.sin(2.0 * time_s + seat), 1.4, -0.43), palm_ahead) for x in sides]
    return hh.TrackingSample(time_s=time_s, head=((0.0, 1.6, 0.0),), hands=hands, grab=[(time_s + 0.3 * seat + 0.5 * x) % 1.1 > 0.5 for x in sides])


class Queue:
    """Every packet takes five ticks, and one of twelve is lost."""

    def __init__(self):
        self.packets, self.sent = [], 0

    def send(self, source, target, frame, data):
        self.sent += 1
        if self.sent % 12 != 0:
            self.packets.append((frame + 5, source, target, data))

    def arrived(self, frame):
        found = [one for one in self.packets if one[0] <= frame]
        self.packets = self.packets[len(found):]
        return found


class Played(unittest.TestCase):
    """A match of 300 ticks, watched from tick 100 on."""

    @classmethod
    def setUpClass(cls):
        cls.server = server = Machine(hh.HH_MATCH_SERVER)
        cls.clients = clients = [Machine(hh.HH_MATCH_CLIENT, seat) for seat in range(SEATS)]
        cls.watcher = watcher = Machine(hh.HH_MATCH_SPECTATOR)
        cls.hashes, cls.seen, cls.watched, cls.drawn_m = {}, [{}, {}], {}, 0.0
        for seat in range(SEATS):
            server.match.connect(seat)
        cls.states = {state: 0 for state in (hh.HH_MATCH_PREDICTED, hh.HH_MATCH_CONFIRMED, hh.HH_MATCH_RETRACTED)}
        queue, told = Queue(), None
        for frame in range(1, 301):
            for _, source, target, data in queue.arrived(frame):
                if target == SERVER:
                    server.match.receive_from(source, frame * TICK_S, data)
                else:
                    clients[target].match.receive(data)
            server.match.confirm(frame * TICK_S)
            tick = server.match.get_stats().tick
            cls.hashes[tick] = server.match.hash(tick)
            for seat, own in enumerate(clients):
                queue.send(SERVER, seat, frame, server.match.packet_to(seat))
                due = own.match.ticks_due(TICK_S)
                for left in range(due, 0, -1):
                    end_s = own.world.time()[0] + TICK_S
                    own.match.advance(dict(samples=[devices(seat, end_s)], buttons=frame % 50 == 0, is_hidden=left > 1))
                    for event in own.match.events():
                        cls.states[int(event["state"])] += int(event["event"]["kind"]) == hh.HH_EVENT_GRABBED
                queue.send(seat, SERVER, frame, own.match.packet())
                stats = own.match.get_stats()
                if stats.confirmed + hh.HH_MATCH_PLACES > stats.tick:
                    cls.seen[seat][stats.confirmed] = own.match.hash(stats.confirmed)
                for slot in range(SEATS):
                    newest = devices(seat, own.world.time()[0]) if slot == seat else None
                    cls.drawn_m = max(cls.drawn_m, own.match.drawn_player(slot, newest)[0].position.x)
            cls.bodies = clients[0].match.drawn_bodies(clients[0].world.bodies())
            cls.offsets = clients[0].match.shown_offsets(0)
            if frame == 100:
                watcher.match.join(server.match.state(hh.HH_MATCH_NO_SLOT))
                watcher.game.grips, watcher.game.presses, told = server.game.grips, server.game.presses, tick
            elif frame > 100:
                data, told = server.match.confirmed_inputs(told)
                watcher.match.receive(data)
                while watcher.match.advance({}):
                    now = watcher.match.get_stats().tick
                    cls.watched[now] = watcher.match.hash(now)

    @classmethod
    def tearDownClass(cls):
        for one in (cls.server, cls.watcher, *cls.clients):
            one.close()

    def test_confirmed_ticks_have_the_hashes_of_the_server(self):
        for machine, least in ((self.seen[0], 150), (self.seen[1], 150), (self.watched, 100)):
            both = machine.keys() & self.hashes.keys()
            self.assertGreater(len(both), least)
            self.assertEqual([machine[tick] for tick in both], [self.hashes[tick] for tick in both])

    def test_grips_happen_and_are_told_twice(self):
        self.assertGreater(self.server.game.grips, 4)
        self.assertGreater(self.states[hh.HH_MATCH_CONFIRMED], 4)
        self.assertGreaterEqual(self.states[hh.HH_MATCH_PREDICTED], self.states[hh.HH_MATCH_CONFIRMED])

    def test_scores_go_back_with_the_world(self):
        for own in self.clients:
            self.assertGreater(own.match.get_stats().rollbacks, 50)
            self.assertGreater(own.game.restored, 0)
            self.assertGreater(own.game.again, 50)
        self.assertEqual(self.server.game.restored, 0)
        self.assertGreater(self.server.game.presses, 4)

    def test_poses_are_drawn(self):
        self.assertAlmostEqual(self.drawn_m, 1.5, delta=0.5)
        self.assertEqual(self.bodies["position"]["z"].tolist(), [-0.6])
        self.assertEqual(len(self.offsets), 3)
        self.assertFalse(self.server.match.needs_state(0))


class Misuse(unittest.TestCase):
    def refused(self, result, text, work, *words, **fields):
        with self.assertRaises(hh.HandholdError) as caught:
            work(*words, **fields)
        self.assertEqual(caught.exception.result, result, caught.exception)
        self.assertIn(text, str(caught.exception))

    def test_a_world_outlives_its_match(self):
        own = Machine(hh.HH_MATCH_CLIENT)
        self.refused(hh.HH_ERROR_STATE, "in a match", own.world.step, TICK_S, [])
        self.refused(hh.HH_ERROR_STATE, "in a match", hh.Match, own.world, players=own.players)
        self.refused(hh.HH_ERROR_STATE, "in a match", own.world.step, TICK_S, [])  # the refused match changed nothing
        own.match.close()
        own.match.close()
        own.world.step(TICK_S, [])
        self.refused(hh.HH_ERROR_NULL, "match", own.match.advance, {})
        with hh.Match(own.world, players=own.players):
            pass
        own.world.close()

    def test_a_closed_world_ends_its_match(self):
        own = Machine(hh.HH_MATCH_CLIENT)
        with self.assertRaises(KeyError), own.world:  # the reason, not a match that is still open
            own.match.advance({})
            raise KeyError("of the game")
        self.refused(hh.HH_ERROR_NULL, "match", own.match.advance, {})
        own.close()

    def test_what_a_match_needs_is_named(self):
        world, players = level()
        with self.assertRaises(TypeError):
            hh.Match(None, players=players)
        with self.assertRaises(TypeError):
            hh.Match(world, 5, players=players)
        self.refused(hh.HH_ERROR_VALUE, "no players", hh.Match, world)
        self.refused(hh.HH_ERROR_VALUE, "tick_s", hh.Match, world, players=players, tick_s=90.0)
        half = type("Half", (), {"save": lambda self, place: None})()
        self.refused(hh.HH_ERROR_VALUE, "save and restore", hh.Match, world, half, players=players)
        world.close()
        self.refused(hh.HH_ERROR_NULL, "world", hh.Match, world, players=players)

    def test_roles_take_their_own_calls_only(self):
        own = Machine(hh.HH_MATCH_CLIENT)
        self.refused(hh.HH_ERROR_STATE, "server", own.match.confirm, 0.0)
        self.refused(hh.HH_ERROR_DATA, "packet", own.match.receive, b"rubbish")
        self.refused(hh.HH_ERROR_VALUE, "slot", own.match.needs_state, 9)
        with self.assertRaises(TypeError):
            copy.copy(own.match)
        own.close()

    def test_what_a_game_raises_reaches_the_call(self):
        for function, error in (("step", KeyError), ("save", ZeroDivisionError)):
            game = Score()
            own = Machine(hh.HH_MATCH_CLIENT, game=game)

            def fail(*_):
                raise error()
            setattr(game, function, fail)
            with self.assertRaises(error):
                for _ in range(3):
                    own.match.advance({})
            own.close()
        game = Score()
        own = Machine(hh.HH_MATCH_SERVER, game=game)
        game.hash = lambda: "no number"
        with self.assertRaises(TypeError):
            own.match.hash(0)
        game.hash = lambda: -1
        self.assertEqual(own.match.hash(0), own.match.hash(0))
        own.close()

    def test_a_game_ends_neither_match_nor_world_and_calls_no_match(self):
        for work in (lambda own: own.match.close(), lambda own: own.world.close(), lambda own: own.match.get_stats()):
            game = Score()
            own = Machine(hh.HH_MATCH_CLIENT, game=game)
            game.step = lambda tick, buttons, own=own, work=work: work(own)
            self.refused(hh.HH_ERROR_STATE, "", own.match.advance, {})
            game.step = lambda tick, buttons: None
            self.assertTrue(own.match.advance({}))
            own.close()

    def test_the_sync_test_names_what_is_forgotten(self):
        for forgets in (False, True):
            game = Score()
            if forgets:
                game.restore = lambda place: None
            own = Machine(hh.HH_MATCH_SYNC_TEST, game=game, sync_ticks=4)
            for frame in range(1, 60):
                inputs = [dict(samples=[devices(seat, frame * TICK_S)], buttons=1) for seat in range(SEATS)]
                found = own.match.sync_test(inputs)
                if found.tick:
                    break
            self.assertEqual((bool(found.tick), bool(found.in_game), bool(found.in_world)), (forgets, forgets, False))
            own.close()

    def test_functions_live_as_long_as_the_match_and_worlds_are_not_kept(self):
        own = Machine(hh.HH_MATCH_CLIENT, game=Score())
        gc.collect()
        junk = [hh.MatchGame(step=lambda *words: self.fail("another function")) for _ in range(50)]
        for _ in range(10):
            self.assertTrue(own.match.advance({}))
        self.assertEqual((own.game.last, len(junk)), (10, 50))
        own.close()
        dropped = Machine(hh.HH_MATCH_CLIENT)
        dropped.game.match = dropped.match  # a ring: the collector may end the world first
        alive = weakref.ref(dropped.world)
        del dropped
        gc.collect()
        self.assertIsNone(alive())


if __name__ == "__main__":
    unittest.main(verbosity=0)
