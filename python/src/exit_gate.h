// How long calls and the end of Python go together: a thread that Python has forgotten must not come back to
// it.
#pragma once

namespace relief::python {

/// Around a call that releases the GIL. When Python ends meanwhile, the end waits for the call, and the
/// thread, which only a daemon thread can be, never goes back to Python: it sleeps until the process is gone.
/// Made and destroyed with the GIL held; throws Error{failed} when Python has ended already.
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
