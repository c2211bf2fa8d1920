// The panel at the right: every control there is, in groups.
#pragma once

#include "session.h"

namespace mirrorball::window {

void draw_panel(Session& session, const Area& area);

}  // namespace mirrorball::window
