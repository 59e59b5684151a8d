"""The picture of a camera by OpenGL, where EGL is present: without a display, with textures and shadows."""

from __future__ import annotations

import ctypes
import functools
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar_robots.mujoco.camera import CHANNELS
from deodar_robots.mujoco.scene_file import simulator

LIBRARY = "libEGL.so.1"

# of the headers of EGL
DEVICE_PLATFORM, OPENGL, NONE = 0x313F, 0x30A2, 0x3038
WANTED = (
    *(0x3024, 8, 0x3023, 8, 0x3022, 8),  # bits of red, green and blue
    *(0x3025, 24),  # of depth
    *(0x3033, 1),  # surfaces outside of a window
    *(0x3040, 8),  # OpenGL
    NONE,
)
MOST_DEVICES = 16

MOST_GEOMS = 10_000
"""Largest number of geoms in a picture, with those that MuJoCo adds."""


class Context:
    """A context of OpenGL without a display, on the first device that has one.

    Raises:
        WorldError: this machine has no EGL, or no device of it.
    """

    def __init__(self) -> None:
        try:
            self._egl = egl = ctypes.CDLL(LIBRARY)
        except OSError:
            raise _absent(f"there is no {LIBRARY}") from None
        pointer, integer = ctypes.c_void_p, ctypes.c_int
        egl.eglGetProcAddress.restype, egl.eglGetProcAddress.argtypes = pointer, [ctypes.c_char_p]
        egl.eglInitialize.argtypes = [pointer] * 3
        egl.eglChooseConfig.argtypes = [pointer, pointer, pointer, integer, pointer]
        egl.eglCreateContext.restype, egl.eglCreateContext.argtypes = pointer, [pointer] * 4
        egl.eglMakeCurrent.argtypes = [pointer] * 4
        query = self._extension(b"eglQueryDevicesEXT", integer, integer, pointer, pointer)
        display_of = self._extension(b"eglGetPlatformDisplayEXT", pointer, integer, pointer, pointer)
        count, devices = integer(), (pointer * MOST_DEVICES)()
        query(MOST_DEVICES, devices, ctypes.byref(count))
        self._display = next(
            (
                display
                for device in devices[: count.value]
                if (display := display_of(DEVICE_PLATFORM, device, None))
                and egl.eglInitialize(display, None, None)
            ),
            None,
        )
        if self._display is None:
            raise _absent("EGL has no device here")
        config, found = pointer(), integer()
        wanted = (integer * len(WANTED))(*WANTED)
        egl.eglChooseConfig(self._display, wanted, ctypes.byref(config), 1, ctypes.byref(found))
        egl.eglBindAPI(OPENGL)
        self._context = egl.eglCreateContext(self._display, config, None, (integer * 1)(NONE))
        if not found.value or not self._context:
            raise _absent("its EGL has no OpenGL")

    def use(self) -> None:
        """Make the context that of the calling thread."""
        if not self._egl.eglMakeCurrent(self._display, None, None, self._context):
            raise WorldError("another thread draws the pictures of a camera", fix='Use render="rays"')

    def release(self) -> None:
        """Leave the context to another thread."""
        self._egl.eglMakeCurrent(self._display, None, None, None)

    def _extension(self, name: bytes, result: Any, *arguments: Any) -> Any:
        address = self._egl.eglGetProcAddress(name)
        if not address:
            raise _absent(f"its EGL has no {name.decode()}")
        return ctypes.CFUNCTYPE(result, *arguments)(address)


class Renderer:
    """Draws the cameras of a compiled scene."""

    def __init__(self, model: Any, size: tuple[int, int]) -> None:
        mujoco = simulator()
        self.size, self._model = size, model
        context().use()
        try:
            shown = model.vis.global_
            shown.offwidth, shown.offheight = max(shown.offwidth, size[0]), max(shown.offheight, size[1])
            self._drawn = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._drawn)
        finally:
            context().release()
        self._scene = mujoco.MjvScene(model, maxgeom=MOST_GEOMS)
        self._options, self._camera = mujoco.MjvOption(), mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED

    def picture(self, data: Any, camera: str, light: float) -> np.ndarray:
        """Return the colours that a camera sees, (columns, rows, 3), from 0 to 1, times `light`."""
        mujoco = simulator()
        columns, rows = self.size
        self._camera.fixedcamid = self._model.camera(camera).id
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(self._model, data, self._options, None, self._camera, everything, self._scene)
        area, pixels = mujoco.MjrRect(0, 0, columns, rows), np.empty((rows, columns, CHANNELS), np.uint8)
        context().use()
        try:
            mujoco.mjr_render(area, self._scene, self._drawn)
            mujoco.mjr_readPixels(pixels, None, area, self._drawn)
        finally:
            context().release()
        seen = pixels[::-1].transpose(1, 0, 2).astype(np.float32) / 255 * np.float32(light)
        return np.clip(seen, 0.0, 1.0)


@functools.cache
def context() -> Context:
    """Return the context of this process."""
    return Context()


def _absent(why: str) -> WorldError:
    return WorldError(
        f"cameras cannot be drawn by EGL: {why}",
        fix='Use render="rays", which needs nothing, or install a driver with EGL, such as libegl1 of Mesa',
    )
