#include "viewer/browser_server.h"

namespace relief::viewer {

// Pictures are asked for one after the other, so that a slow line gets fewer; events go by a WebSocket.
const char* const kBrowserPage = R"(<!DOCTYPE html>
<html><head><meta charset="utf-8"><title>Relief</title><style>
body { margin: 0; background: #17171a; color: #ccc; font: 14px sans-serif; }
img { display: block; max-width: 100vw; max-height: calc(100vh - 2em); cursor: grab; user-select: none; }
pre { margin: 0.4em; }
</style></head><body><img id="picture" draggable="false" alt=""><pre id="text">waiting for a picture</pre><script>
const token = new URLSearchParams(location.search).get("token");
const picture = document.getElementById("picture"), text = document.getElementById("text");
const events = new WebSocket(`ws://${location.host}/events?token=${token}`);
const send = (kind, e, more) => {
  if (events.readyState !== 1 || !picture.naturalWidth) return;
  const box = picture.getBoundingClientRect();
  events.send(JSON.stringify({kind, x: (e.clientX - box.left) / box.width, y: (e.clientY - box.top) / box.height,
    button: e.button || 0, shift: e.shiftKey, control: e.ctrlKey, alt: e.altKey, ...more}));
};
let held = false;
picture.onpointerdown = e => { held = true; picture.setPointerCapture(e.pointerId); send("press", e); e.preventDefault(); };
picture.onpointermove = e => { if (held) send("move", e); };
picture.onpointerup = picture.onpointercancel = e => { held = false; send("release", e); };
picture.onwheel = e => { send("scroll", e, {amount: -Math.sign(e.deltaY)}); e.preventDefault(); };
picture.oncontextmenu = e => e.preventDefault();
const keys = {ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down", "+": "+", "-": "-", ".": ".",
  Escape: "escape"};
onkeydown = e => { if (keys[e.key]) send("key", {clientX: 0, clientY: 0}, {key: keys[e.key], repeat: e.repeat}); };
async function follow() {
  for (let after = 0, last = "";;) {
    try {
      const answer = await fetch(`/picture?token=${token}&after=${after}`);
      if (answer.status === 204) continue;
      if (!answer.ok) { text.textContent = `refused: ${answer.status}`; return; }
      after = answer.headers.get("X-Relief-Version");
      text.textContent = decodeURIComponent(answer.headers.get("X-Relief-Text"));
      const url = URL.createObjectURL(await answer.blob());
      // Not decode(): it waits as long as the page is hidden.
      await new Promise(done => { picture.onload = picture.onerror = done; picture.src = url; });
      if (last) URL.revokeObjectURL(last);
      last = url;
    } catch (error) {
      text.textContent = "the viewer has ended";
      return;
    }
  }
}
follow();
</script></body></html>
)";

} // namespace relief::viewer
