// What lies over the picture: the hand that moves things, the wipe's line, texts.
#pragma once

#include "session.h"

namespace mirrorball::window {

void draw_overlay(Session& session);

}  // namespace mirrorball::window
