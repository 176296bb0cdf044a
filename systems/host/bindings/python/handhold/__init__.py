"""Handhold in Python, for tools: the C interface with ctypes and numpy.

Names, units and defaults are those of the C headers (systems/host/include/handhold). Methods of a World are the functions hh_world_x as x, and
hh_body_x, hh_player_x and the others as body_x, player_x; those of a Match are hh_match_x as x. Lists come back as numpy arrays with the structs' fields: poses["position"]["x"].
A call that the library refuses raises HandholdError, and nothing has changed.
"""
import ctypes
import operator

from . import _generated
from ._generated import *  # noqa: F401,F403
from ._generated import (HH_LEFT, HH_RIGHT, MatchCalls, MatchDef, MatchGame, MeshDef, PlayerInput, Pose, SurfaceQuery, WorldCalls,
                         WorldDef)
from ._library import HandholdError, check, lib, load, optional, refuse_in_callback  # noqa: F401


class _Owner:
    """What has a handle of the library: usable in a `with` statement, and not copied, because the handle is freed once."""

    _why_not_copied = ""

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()

    def __copy__(self, *_):
        raise TypeError(f"a {type(self).__name__.lower()} cannot be copied{self._why_not_copied}")

    __deepcopy__ = __copy__


class Mesh(_Owner):
    """Triangles for shapes and surfaces: hh_mesh_create. Shapes keep what they need; close() gives the memory back."""

    def __init__(self, definition=None, **fields):
        self._handle = ctypes.c_void_p()
        check(lib().hh_mesh_create(optional(MeshDef, definition, fields), ctypes.byref(self._handle)))

    def close(self) -> None:
        refuse_in_callback("a mesh cannot be closed")
        self.__del__()

    def __del__(self):
        if getattr(self, "_handle", None):
            lib().hh_mesh_destroy(self._handle)
            self._handle = ctypes.c_void_p()


class Surfaces:
    """The surfaces of a host with physics of its own: hh_surface_query. Each function returns a SurfaceHit, or None if it finds nothing. `skip`:
    bodies that count as not there. What a function raises counts as nothing found, and is raised when the step has ended. A subclass may add
    cast_sphere(radius_m, start, end, skip), which keeps trunk and legs out of surfaces."""

    def cast_ray(self, start, end, skip):
        return None

    def closest_point(self, point, max_distance_m, skip):
        return None

    def closest_point_on(self, body, point):
        return None


class World(_Owner, WorldCalls):
    """A simulation: hh_world_create. Close it, or use it in a `with` statement."""

    _why_not_copied = ": save() and restore() copy its state"

    def __init__(self, definition=None, **fields):
        self._handle = ctypes.c_void_p()
        self._kept = {}
        self._match = None  # the handle of its match, null when that has ended
        check(lib().hh_world_create(optional(WorldDef, definition, fields), ctypes.byref(self._handle)))

    def close(self) -> None:
        """Ends the world's match, if any, and destroys the world. Not inside a callback: HH_ERROR_STATE."""
        refuse_in_callback("a world cannot be closed")
        self.__del__()

    def __del__(self):
        if getattr(self, "_match", None):
            _end_match(self._match)
        if getattr(self, "_handle", None):
            lib().hh_world_destroy(self._handle)
            self._handle = ctypes.c_void_p()
            self._kept.clear()

    def step_player(self, dt_s, player, samples, **commands) -> None:
        """hh_world_step for a world with one player. `samples`: TrackingSamples or dictionaries of their fields."""
        self.step(dt_s, [PlayerInput(player=player, samples=samples, commands=commands)])

    def use_wrists(self, player) -> None:
        """Samples are wrists with OpenXR's axes, not controllers."""
        for side in (HH_LEFT, HH_RIGHT):
            self.player_set_hand_in_controller(player, side, Pose())

    def player_pose(self, player):
        """hh_player_pose of one player: origin, head, velocity_mps, hands."""
        return _generated.PlayerPose.from_buffer_copy(self.player_poses([player])[0].tobytes())

    def set_surfaces(self, surfaces) -> None:
        """Hands ask `surfaces` from now on (a Surfaces, or anything with its functions); None: the world's shapes."""
        query = None
        if surfaces is not None:
            query = SurfaceQuery(cast_ray=_answer(lambda start, end, skip, count: surfaces.cast_ray(start, end, skip[:count])),
                                 closest_point=_answer(lambda point, max_m, skip, count: surfaces.closest_point(point, max_m, skip[:count])),
                                 closest_point_on=_answer(surfaces.closest_point_on))
            if hasattr(surfaces, "cast_sphere"):
                query.cast_sphere = _answer(lambda radius_m, start, end, skip, count: surfaces.cast_sphere(radius_m, start, end, skip[:count]))
        self.set_surface_query(query)


class Match(_Owner, MatchCalls):
    """A world's part in a match: hh_match_create. Your transport carries its packets. Close it, or use it in a `with` statement; its world's close() ends it too.

    `game`: your own state, which goes back and forth with the world's. It has the functions step(tick, buttons), save(place), restore(place) and
    hash() of hh_match_game; those that it lacks are not called. What a function raises first is raised when the call of the match
    has ended. That call still takes effect, as if the function had returned (hash: 0)."""

    def __init__(self, world, game=None, definition=None, **fields):
        if not isinstance(world, World):
            raise TypeError(f"a match needs a World, not {world!r}")
        self._handle = ctypes.c_void_p()
        self._world = world  # lives as long as the match
        self._kept = None if game is None else _game_of(game)
        result = lib().hh_match_create(world._handle, optional(MatchDef, definition, fields), optional(MatchGame, self._kept), ctypes.byref(self._handle))
        if self._handle:
            world._match = self._handle
        try:
            check(result)
        except BaseException:
            self.__del__()
            raise

    def close(self) -> None:
        """Ends the match; the world stays as it is. Not inside a callback: HH_ERROR_STATE."""
        refuse_in_callback("a match cannot be closed")
        self.__del__()

    def __del__(self):
        if getattr(self, "_handle", None):
            _end_match(self._handle)


def _end_match(match) -> None:
    lib().hh_match_destroy(match)
    match.value = None  # for the world too, which has the same object


def _game_of(game):
    functions = {"step": lambda context, tick, buttons, count: game.step(tick, buttons[:count]), "save": lambda context, place: game.save(place),
                 "restore": lambda context, place: game.restore(place),
                 "hash": lambda context: operator.index(game.hash()) & 0xffffffffffffffff}
    found = {name: call for name, call in functions.items() if hasattr(game, name)}
    if not found:
        raise TypeError(f"{game!r} has none of the functions of a game: {', '.join(functions)}")
    return MatchGame(**found)


def _answer(find):
    def call(context, *words):
        *given, hit = words
        found = find(*given)
        if found is None:
            return 0
        hit[0] = found
        return 1
    return call
