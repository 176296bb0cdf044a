"""Finds and loads the shared library, and converts between Python, numpy and C."""
import ctypes
import ctypes.util
import os
import sys
import threading
from pathlib import Path

import numpy as np

_loaded = None


class HandholdError(Exception):
    """A call that the library refused. `result`: its HH_ERROR_ number."""

    def __init__(self, result: int, text: str):
        super().__init__(text)
        self.result = result


def load(path=None) -> None:
    """Loads the library from `path`. By default: HANDHOLD_LIBRARY, the file in this package, else the system's. Called by the first use."""
    global _loaded
    from . import _generated
    name = {"win32": "handhold.dll", "darwin": "libhandhold.dylib"}.get(sys.platform, "libhandhold.so")
    beside = Path(__file__).with_name(name)
    version = f"{_generated.HANDHOLD_VERSION_MAJOR}.{_generated.HANDHOLD_VERSION_MINOR}"
    found = path or os.environ.get("HANDHOLD_LIBRARY") or (str(beside) if beside.exists() else None) \
        or ctypes.util.find_library("handhold") or f"{name}.{version}"
    library = ctypes.CDLL(str(found))
    running = [ctypes.c_uint32() for _ in range(3)]
    library.hh_version(*map(ctypes.byref, running))
    if [n.value for n in running[:2]] != [_generated.HANDHOLD_VERSION_MAJOR, _generated.HANDHOLD_VERSION_MINOR]:
        # Before 1.0.0 every minor version may change the interface.
        raise ImportError(f"{found} has version {'.'.join(str(n.value) for n in running)}; this package needs {version}")
    for function, (returns, params) in _generated.FUNCTIONS.items():
        entry = getattr(library, function)
        entry.restype, entry.argtypes = returns, params
    _loaded = library


def lib():
    if _loaded is None:
        load()
    return _loaded


class Callbacks(threading.local):
    """What this thread's callbacks did: how many are running, and the first exception since the last call of the library ended."""

    running = 0
    error = None


_callbacks = Callbacks()


def guarded(work):
    """`work` as a function that the library may call: what it raises is raised when the call of the library has ended."""
    def call(*words):
        _callbacks.running += 1
        try:
            return work(*words)
        except BaseException as error:  # must not cross the library
            _callbacks.error = _callbacks.error or error
            return 0
        finally:
            _callbacks.running -= 1
    return call


def refuse_in_callback(what: str) -> None:
    from . import _generated
    if _callbacks.running:
        raise HandholdError(_generated.HH_ERROR_STATE, f"HH_ERROR_STATE: {what} inside a callback")


def check(result: int) -> None:
    error, _callbacks.error = _callbacks.error, None
    if error is not None:
        raise error
    if result != 0:
        raise HandholdError(result, f"{lib().hh_result_text(result).decode()}: {lib().hh_last_error().decode()}")


class Struct(ctypes.Structure):
    """A struct of the C interface. Keywords set fields; the others keep the library's defaults, or 0. Fields that are structs take tuples, texts
    take str, and fields that point to arrays take sequences and set their count."""

    _default_ = ""
    _arrays_: dict = {}

    def __init__(self, *values, **fields):
        super().__init__()
        if self._default_:
            check(getattr(lib(), self._default_)(ctypes.byref(self), ctypes.sizeof(self)))
        elif self._fields_[0][0] == "position" and len(self._fields_) == 2:
            self.rotation.w = 1.0  # a pose without a rotation is not turned
        names = [name for name, *_ in self._fields_]
        if len(values) > len(names):
            raise TypeError(f"{type(self).__name__} has {len(names)} fields, {len(values)} are given")
        for name, given in [*zip(names, values), *fields.items()]:
            if name not in names:
                raise TypeError(f"{type(self).__name__} has no field {name}")
            setattr(self, name, given)

    def __setattr__(self, name, given):
        kinds = {field: kind for field, kind, *_ in self._fields_}
        if name not in kinds:
            raise AttributeError(f"{type(self).__name__} has no field {name}")
        kind = kinds[name]
        if name in self._arrays_:
            counter, each = self._arrays_[name]
            elements, count = array(kind._type_, given)
            if count % each != 0 or getattr(given, "ndim", 1) > 1 and given.shape[-1] != each:
                raise TypeError(f"{name}: rows of {each} numbers are needed")
            self._keep(name, elements)
            super().__setattr__(name, ctypes.cast(elements, kind))
            super().__setattr__(counter, count // each)
            return
        if kind is ctypes.c_char_p and isinstance(given, str):
            given = given.encode()
        elif isinstance(kind, type) and issubclass(kind, Struct):
            given = value(kind, given)
        elif isinstance(kind, type) and issubclass(kind, ctypes.Array):
            given = list(given)
            if len(given) != kind._length_:
                raise TypeError(f"{name}: {kind._length_} elements are needed, {len(given)} are given")
            given = kind(*[value(kind._type_, one) for one in given])
        elif isinstance(kind, type) and issubclass(kind, ctypes._CFuncPtr):
            given = given if isinstance(given, kind) else kind() if given is None else kind(guarded(given))
            self._keep(name, given)
        super().__setattr__(name, given)

    def _keep(self, name, kept):
        self.__dict__.setdefault("_kept", {})[name] = kept

    def __eq__(self, other):
        return type(self) is type(other) and bytes(self) == bytes(other)

    def __hash__(self):
        return hash(bytes(self))

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name, *_ in self._fields_)})"

    def __array__(self, dtype=None):
        return np.frombuffer(self, dtype=np.float64).astype(dtype or np.float64)


def value(kind, given):
    """`given` as `kind`: an instance, a tuple, a dictionary, an element of a numpy array, a sequence of numbers, or None for all zero. A vector or
    quaternion of another library is read by its attributes x, y, z, w."""
    if isinstance(given, kind) or not issubclass(kind, Struct):
        return given
    if isinstance(given, np.void):
        return kind.from_buffer_copy(given.tobytes())
    if given is None:
        return kind.from_buffer_copy(bytes(ctypes.sizeof(kind)))  # a null id
    if isinstance(given, dict):
        return kind(**given)
    if isinstance(given, Struct):
        raise TypeError(f"{type(given).__name__} where {kind.__name__} is needed")
    refused = f"{kind.__name__} or a sequence of its fields is needed, not {given!r}"
    if isinstance(given, (str, bytes, bytearray)):
        raise TypeError(refused)
    try:
        words = tuple(given)  # Blender's vectors are sequences without __iter__
    except TypeError as error:
        raise TypeError(refused) from error
    if all(one is ctypes.c_double for _, one in kind._fields_):
        names = [name for name, _ in kind._fields_]
        if len(words) < len(names):
            raise TypeError(f"{kind.__name__} has {len(names)} numbers, {len(words)} are given")
        if len(words) == len(names) and all(hasattr(given, name) for name in names):
            words = tuple(getattr(given, name) for name in names)  # Blender's quaternions begin with w
    return kind(*words)


def optional(kind, given, fields=None):
    """The address of a struct; null for None. A definition without one has the library's defaults and `fields`."""
    if fields and given is not None:
        raise TypeError("give a definition or its fields, not both")
    if fields is not None and given is None:
        given = kind(**fields)
    return None if given is None else ctypes.byref(value(kind, given))


def held(kind, given):
    """A copy of a struct with callbacks that keeps them alive, whatever becomes of `given`."""
    if given is None:
        return None
    given = value(kind, given)
    made = kind.from_buffer_copy(given)
    made.__dict__["_kept"] = dict(given.__dict__.get("_kept", {}))
    return made


def numbers_of(kind):
    """The type of all numbers of a struct; None if they have several types."""
    kinds = {numbers_of(one[0]) for one in kind.fields.values()} if kind.fields is not None else {kind.base if kind.subdtype else kind}
    return kinds.pop() if len(kinds) == 1 else None


def fixed(kind, given, length, name):
    """A C array of `kind` with exactly `length` elements."""
    made, count = array(kind, given)
    if count != length:
        raise TypeError(f"{name}: {length} elements of {kind.__name__} are needed, {count} are given")
    return made


def array(kind, given):
    """A C array of `kind` and its length. Numpy arrays of the right type are passed without a copy; rows of numbers are structs of numbers."""
    if given is None:
        return None, 0
    if isinstance(given, np.ndarray):
        wanted = np.dtype(kind)
        if given.dtype != wanted and wanted.fields is not None:
            number = numbers_of(wanted)
            if number is None or given.ndim != 2 or given.shape[1] * number.itemsize != wanted.itemsize or not np.can_cast(given, number, "same_kind"):
                raise TypeError(f"an array of {kind.__name__} is needed, or rows of its numbers; not {given.dtype} of shape {given.shape}")
            made, count = np.ascontiguousarray(given, dtype=number), given.shape[0]
        else:
            if wanted.fields is None and given.size > 0 and given.dtype.kind not in ("iu" if wanted.kind in "iu" else "iuf") and given.dtype != wanted:
                raise TypeError(f"{'whole numbers' if wanted.kind in 'iu' else 'numbers'} are needed, not {given.dtype}")
            made = np.ascontiguousarray(given, dtype=wanted)
            count = made.size
        pointer = made.ctypes.data_as(ctypes.POINTER(kind))
        pointer._kept_array = made
        return pointer, count
    elements = [value(kind, one) for one in given]
    made = (kind * max(len(elements), 1))(*elements)
    made._kept_elements = elements  # texts and arrays that they point to
    return made, len(elements)


def empty(kind, count):
    """A numpy array of zeros for the library to fill, and its address."""
    made = np.zeros(count, dtype=kind)
    return made, made.ctypes.data_as(ctypes.POINTER(kind))


def changed(kind, given):
    """A copy as a numpy array, for the library to change, and its address."""
    made = np.array(given, dtype=kind)
    return made, made.ctypes.data_as(ctypes.POINTER(kind))


def copied(kind, pointer, count):
    if count.value == 0:
        return np.zeros(0, dtype=kind)
    return np.frombuffer(ctypes.string_at(pointer, count.value * ctypes.sizeof(kind)), dtype=kind).copy()


def listed(kind, call):
    """A list whose length, or the most that it may have, the library says in a first call. Bytes for c_uint8, else a numpy array."""
    count = ctypes.c_size_t()
    check(call(None, 0, ctypes.byref(count)))
    made, at = empty(kind, count.value)
    check(call(at, count.value, ctypes.byref(count)))
    made = made[:count.value]
    return made.tobytes() if kind is ctypes.c_uint8 else made


def raw(given):
    """Bytes or a text for the library, and the number of bytes; None is null."""
    if given is None:
        return None, 0
    made = given.encode() if isinstance(given, str) else bytes(given)
    return made, len(made)


def text(given):
    return given.encode() if isinstance(given, str) else given


def shown(given):
    return None if given is None else given.decode()


def handle(given):
    return None if given is None else given._handle
