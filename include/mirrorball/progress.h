// Long work tells its caller how far it is, and stops when the caller asks.
#pragma once

#include <functional>

namespace mirrorball {

/// Called with the share of the work that is done, 0 to 1, not decreasing, from one thread at a
/// time. Returns whether to go on; after `false` the work throws Error(Errc::cancelled). May be
/// empty.
using Progress = std::function<bool(double fraction)>;

}  // namespace mirrorball
