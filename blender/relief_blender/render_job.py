"""A render in a thread of its own, so that Blender is only called from the thread that asks for it."""
import queue
import threading

import relief


class RenderJob:
    """Renders a relief.Scene; pictures and progress come by poll()."""

    def __init__(self, scene, settings, picture_interval=0.5):
        self._news = queue.Queue()
        self.on_news = None  # called from the render's thread when there is something for poll()
        self._is_cancelled = threading.Event()
        self._settings = dict(settings, picture_interval=picture_interval)
        self._thread = threading.Thread(target=self._run, args=(scene,), name="relief", daemon=True)
        self._thread.start()

    def _run(self, scene):
        try:
            picture = relief.render(scene, progress=self._on_progress, on_picture=self._on_picture, **self._settings)
            self._tell(("done", picture))
        except Exception as fault:  # handed to the thread that asked for the render
            self._tell(("fault", fault))

    def _on_progress(self, progress):
        self._tell(("progress", progress))
        return not self._is_cancelled.is_set()

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

    def cancel(self):
        self._is_cancelled.set()

    def join(self):
        self._thread.join()
