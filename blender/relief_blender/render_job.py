"""A render in a thread of its own, so that Blender is only called from the thread that asks for it."""
import queue
import threading

import relief

_left = []  # threads that nobody waits for


class RenderJob:
    """Renders a relief.Scene; pictures and progress come by poll(). on_end() is called when the scene is no longer used."""

    def __init__(self, scene, settings, picture_interval=0.5, on_end=None):
        self._news = queue.Queue()
        self.on_news = None  # called from the render's thread when there is something for poll()
        self._is_cancelled = threading.Event()
        self._settings, self._picture_interval = dict(settings), picture_interval
        self._thread = threading.Thread(target=self._run, args=(scene, on_end), name="relief", daemon=True)
        self._thread.start()

    def _run(self, scene, on_end):
        news = None
        try:
            news = "done", self._render(scene)
        except Exception as fault:  # handed to the thread that asked for the render
            news = "fault", fault
        finally:
            if on_end is not None:
                on_end()
        self._tell(news)

    def _render(self, scene):
        return relief.render(scene, progress=self._on_progress, on_picture=self._on_picture,
                             picture_interval=self._picture_interval, **self._settings)

    def _on_progress(self, progress):
        self._tell(("progress", progress))
        return not self.is_cancelled

    def _on_picture(self, picture):
        self._tell(("picture", picture))

    def _tell(self, news):
        self._news.put(news)
        if self.on_news is not None:
            self.on_news()

    def poll(self, timeout):
        """(kind, thing): kind is progress, picture, done, fault, or None after `timeout` seconds."""
        try:
            return self._news.get(timeout=timeout)
        except queue.Empty:
            return None, None

    @property
    def is_cancelled(self):
        return self._is_cancelled.is_set()

    def cancel(self):
        """Asks for the end, which is done or fault, and comes within a moment."""
        self._is_cancelled.set()

    def leave(self):
        """Cancels, for who takes no more news: the thread ends by itself."""
        self.cancel()
        if self._thread.is_alive():
            _left.append(self._thread)


def describe(progress):
    """A line of a Progress for the status of Blender."""
    if progress.prepared < 1 and progress.fraction == 0:
        return f"Preparing surfaces, {progress.prepared:.0%}"
    return f"Sample {progress.samples_done}/{progress.samples_total}"


def has_left(timeout):
    """Whether a render that was left goes on after so many seconds: two preparations at once could want too much memory."""
    _left[:] = [thread for thread in _left if thread.is_alive()]
    if not _left:
        return False
    _left[0].join(timeout)
    return any(thread.is_alive() for thread in _left)
