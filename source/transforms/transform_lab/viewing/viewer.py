"""Shows frames, points, arrows, boxes, grippers and markers in 3D, as RViz does, inside a notebook.

Nothing is started and nothing listens: the scene is drawn into the notebook itself and stays there when it is saved.

Beside RViz (1.14; tests/ros/test_rviz.py draws every sort of marker with both): markers are where RViz has them, as large,
and it says what RViz says. What differs:

===================== ============================================ =================================================
what                  RViz                                         here
===================== ============================================ =================================================
light                 one lamp; what is turned away is black       brighter; both sides of triangles are lit
lines                 flat ribbons that face the viewer, mitred    rods; a colour that changes along a line has steps
POINTS                scale.x wide and scale.y high with Mesa,      squares of scale.x, upright
                      turned with the marker; with other drivers
                      upright squares of scale.x
SPHERE_LIST           of three sizes: ovals that face the viewer   ellipsoids, as a SPHERE of this scale is
texts                 Liberation Sans                              another font, as high; a line may be wider or narrower
lifetime              the marker goes away                         it stays
frame_id unknown      a marker waits in a queue of 100, DELETE too any number waits; DELETE deletes
MESH_RESOURCE         is drawn                                     ValueError
over 2000 points      are drawn                                    ValueError (POINTS: any number)
===================== ============================================ =================================================
"""

import inspect
import io
import numbers

import numpy as np

from ..jupyter import being_graded
from .camera import VIEWS, Camera
from .carriers import carries
from .motion import Motion, control
from .scene import Scene

__all__ = ["Viewer"]


class Viewer(Scene):
    """A scene of frames, and of what is given in them; lengths are in metres.

    ::

        viewer = Viewer("base_link")
        viewer.add_frame("camera", base_T_camera)
        viewer.add_point("object", p_in_camera, frame="camera")
        viewer                                   # as the last line of a cell, or viewer.show()

    `fixed_frame` is the root of the tree of frames, and what the scene is first looked at from; in the picture, or by
    `viewer.fixed_frame = "camera"`, any other can be made the fixed one, as in RViz. The x axes are red, y green, z blue,
    and lettered. Drag to turn, click and use the wheel to zoom, drag with the right button to move.

    Adding something under a name that is taken replaces it. `viewer.text` is shown in the corner. With `ghost`, the fixed
    frame is translucent, for what is to be seen in its place; `length` is that of its axes, as in `add_frame`.
    """

    def __init__(self, fixed_frame="world", ghost=False, length=None):
        super().__init__(fixed_frame, ghost, length)
        self._seen_from, self.at = "overview", None
        self._motion = self._link = None  # what moves it, and what keeps its live figures up to date

    # Looking at it

    def look(self, seen_from=None, at=None):
        """Choose from where the scene is looked at first, and at what; None leaves it as it is. Returns the viewer.

        `seen_from` is "overview", "above" (x to the right, y up), "side" (x to the right, z up) or "behind" (as the robot
        sees it: x ahead, y to the left). `at` is a list of names of frames, points, arrows and boxes that have to be in
        view; by default everything has to be.
        """
        seen_from = seen_from or self._seen_from
        if not isinstance(seen_from, str) or seen_from not in VIEWS:
            raise ValueError(f"seen_from must be one of {', '.join(VIEWS)}; got {seen_from!r}")
        at = [at] if isinstance(at, str) else list(at or ())
        if at:  # else there is no need to ask what is shown
            scene = self.state()
            known = [*scene.frames, *scene.points, *scene.arrows, *scene.boxes]
            for name in at:
                if name not in known:
                    raise ValueError(f"look: nothing here is called {name!r}. Known names: {', '.join(known)}")
        self._seen_from, self.at = seen_from, at or self.at
        return self

    def animate(self, function, seconds=4):
        """Make the scene an animation of `seconds`, to be played and scrubbed; it works in a saved notebook too.

        `function(scene, moment)` is called with moments from 0 to 1, and each time adds to `scene`, which holds what the
        viewer holds, what there is to see then. What it returns is shown as text. The picture shows the end. Returns the
        viewer.
        """
        if not isinstance(seconds, numbers.Real) or not 0 < float(seconds) < 3600:
            raise ValueError(f"animate: seconds must be a number above 0; got {seconds!r}")
        return self._move(Motion(function, seconds=float(seconds)))

    def interact(self, function, **controls):
        """Give the scene sliders and drop-down lists, one for each further argument of `function`. Returns the viewer.

        ::

            def turn(scene, degrees):
                scene.add_frame("frame_b", tft.rotation_matrix(np.radians(degrees), [0, 0, 1]))

            Viewer("frame_a").interact(turn, degrees=(-180, 180))

        The controls are given as to ipywidgets' `interact`: (min, max) or (min, max, step) is a slider, a list is a
        drop-down list, True or False a choice of the two; they start at the function's defaults. `scene` holds what the
        viewer holds; add to it with its `add_…` and `publish`. What the function returns is shown as text, and so is an
        error that it raises.

        In a notebook whose kernel runs, the function is called while the student drags. In a saved one the controls show
        what was computed beforehand: at most 48 states; more combinations than that need the kernel.
        """
        empty = inspect.Parameter.empty
        parameters = list(inspect.signature(function).parameters.values())[1:]
        defaults = {p.name: p.default for p in parameters if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)}
        if missing := [name for name in defaults if name not in controls and defaults[name] is empty]:
            raise ValueError(f"interact: give a control for {', '.join(missing)}, such as {missing[0]}=(0, 90)")
        if not controls:
            raise ValueError("interact: give at least one control, such as degrees=(0, 90)")
        made = [control(name, choices, defaults.get(name, empty)) for name, choices in controls.items()]
        return self._move(Motion(function, made))

    def _move(self, motion):
        """Keep `motion`; an error that its function raises at the start is the caller's."""
        motion.check()
        motion.scene(self, motion.arguments, strict=True)
        self._motion, self._link = motion, None
        return self

    def state(self):
        """Return the Scene that is shown: what the viewer holds, and what an animation or controls add to it now."""
        return self.state_of(self._motion)

    def state_of(self, motion):
        """Return the Scene of what the viewer holds and of what `motion`, a Motion or None, adds to it now."""
        return motion.scene(self, motion.arguments) if motion else self.copy()

    def description(self):
        return Scene.description(self.state())

    def _changed(self):
        if self._link:
            self._link.refresh()

    # Showing it

    def show(self, live=False):
        """Display the scene as it is now, below the cell.

        A `live` one follows: what is added to the viewer later on shows there at once, as long as the kernel runs. Use
        it with ipywidgets of your own. The camera stays where it is, and so does the list of frames to be the fixed one.
        """
        from IPython.display import display

        display(self._bundle(live), raw=True)

    def html(self):
        """Return the scene as a page of its own (text): write it to a file and open that in a browser."""
        return (
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Frames</title></head>'
            f'<body style="font-family: sans-serif">{self._figure(self.state(), None, carries=True)}</body></html>\n'
        )

    def _repr_mimebundle_(self, include=None, exclude=None):
        return self._bundle(live=False)

    def _bundle(self, live):
        scene = self.state()
        bundle = {"text/plain": Scene.description(scene)}
        if not being_graded():  # nobody looks while a notebook is graded
            bundle["text/html"] = self._figure(scene, self._linked(live), carries())
        return bundle

    def __repr__(self):
        return self.description()

    def figure(self, live=False):
        """Return the scene as a piece of HTML: the interactive page over the still picture.

        With controls, or if `live`, the page asks the kernel for what to show, if it runs in a notebook with a kernel.
        """
        return self._figure(self.state(), self._linked(live), carries())

    def _linked(self, live):
        """Return the Link of a figure that asks the kernel; None where there is nothing to ask, or no kernel."""
        if not live and not (self._motion and self._motion.controls):
            return None
        from .live import Link, has_kernel

        if has_kernel() and self._link is None:
            self._link = Link(self, self._motion)
        return self._link

    def _figure(self, scene, link, carries):
        from . import page

        drawing, states, length = self._drawings(scene)
        if link:
            link.length = length
            if not states:
                drawing.leave_room(length)
        body = page.render(
            drawing, scene.fixed_frame, self._seen_from, self._motion, states, link and link.name, carries
        )
        still = self._picture(scene, drawing, page.text_height([drawing, *states]))
        caption = self._caption(scene, [drawing, *states], length)
        rows = 1 + (len(self._motion.controls) + bool(self._motion.seconds) if self._motion else 0)
        return page.over_picture(body, still, Scene.description(scene), caption, rows, carries)

    def still(self):
        """Return the scene as a still picture in HTML, with its text for screen readers: for pages without scripts."""
        from . import page

        scene = self.state()
        drawing, states, length = self._drawings(scene)
        picture = self._picture(scene, drawing, page.text_height([drawing, *states]))
        return page.still(picture, Scene.description(scene), self._seen_in(scene, [drawing], length))

    def picture(self):
        """Return the scene as a still picture: the bytes of a PNG file."""
        from . import page

        scene, file = self.state(), io.BytesIO()
        drawing, states, _ = self._drawings(scene)
        self._picture(scene, drawing, page.text_height([drawing, *states])).save(file, "PNG", optimize=True)
        return file.getvalue()

    def _drawings(self, scene):
        """Return the Drawing of the `scene` that is shown, those of the states computed beforehand, the length of axes."""
        from .drawing import draw_all

        scenes = self._motion.scenes(self, scene) if self._motion else []
        drawings, length = draw_all(scenes or [scene], self.at)
        return (drawings[self._motion.start], drawings, length) if scenes else (*drawings, [], length)

    def _picture(self, scene, drawing, top):
        from . import page, picture
        from .drawing import grid, in_frame

        seen = drawing.seen_from(scene.fixed_frame)
        camera = Camera(seen, page.ASPECT, self._seen_from, top)
        nodes = in_frame(drawing.nodes, drawing.frames[scene.fixed_frame])
        return picture.render(nodes, grid(seen)[0], camera, drawing.text)

    def _caption(self, scene, drawings, length):
        """Return a line on what is to be seen and how to turn it."""
        return f"{self._seen_in(scene, drawings, length)} Drag to turn, click and scroll to zoom."

    def _seen_in(self, scene, drawings, length):
        """Return a line on the fixed frame, the axes and the grid."""
        from .drawing import grid

        lengths = {frame.length or length for frame in scene.frames.values()}
        long = " to ".join(f"{value:g}" for value in sorted({min(lengths), max(lengths)}))
        _, step = grid(np.concatenate([drawing.seen_from(scene.fixed_frame) for drawing in drawings]))
        axes = f"Axes {long} m long: X red, Y green, Z blue."
        return f"Fixed frame {scene.fixed_frame}. {axes} Grid at z = 0, squares of {step:g} m."
