// The strip of maps under the picture, and where on each of them the pixel under the mouse looks.
#pragma once

#include <map>
#include <utility>

#include "gl/objects.h"
#include "session.h"

namespace mirrorball::window {

class MapStrip {
  public:
    /// Of a strip that is so wide.
    [[nodiscard]] static int height_for(int width, double scale);
    void draw(Session& session, const Area& area);

  private:
    struct Uploaded {
        gl::TextureName name;
        std::uint64_t version = 0;
    };
    GLuint texture_of(Session& session, Projection projection, int height);

    std::map<std::pair<MapContent, Projection>, Uploaded> uploaded_;
};

}  // namespace mirrorball::window
