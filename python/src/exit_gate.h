// How long calls and the end of Python go together: a thread that Python has forgotten must not come back to
// it.
#pragma once

namespace relief::python {

/// Around a call that releases the GIL; may be within another of the same thread, by a callback. When Python
/// ends meanwhile, the end waits for the outermost call, and the thread, which only a daemon thread can be,
/// never goes back to Python: it sleeps until the process is gone. A visit that begins later sleeps as well,
/// or throws Error{failed} on the thread that ends Python and within a visit from before. Made and destroyed
/// with the GIL held.
class GateVisit {
  public:
    GateVisit();
    ~GateVisit();
    GateVisit(const GateVisit&) = delete;
    GateVisit& operator=(const GateVisit&) = delete;
};

/// Whether Python is ending, so that calls are to return soon. Thread safe.
bool is_gate_closing();

/// To be called by Python's atexit, with the GIL: waits for all visits to end.
void close_gate();

} // namespace relief::python
