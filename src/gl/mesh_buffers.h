// Meshes on the graphics card. Attributes are those of shaders/surface.vert.
#pragma once

#include <array>

#include <mirrorball/mesh.h>

#include "objects.h"

namespace mirrorball::gl {

class MeshBuffers {
  public:
    explicit MeshBuffers(const Mesh& mesh);
    void draw() const;
    /// Of the mesh, in its own frame.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }

  private:
    VertexArray array_;
    std::array<Buffer, 5> buffers_;  // positions, normals, texture coordinates, tangents, indices
    GLsizei index_count_;
    Bounds bounds_;
};

/// The same for polygons split by cube face, which change with the eye.
class SplitMeshBuffers {
  public:
    explicit SplitMeshBuffers(const SplitMesh& mesh);
    void draw(int face) const;

  private:
    VertexArray array_;
    std::array<Buffer, 4> buffers_;
    std::array<GLsizei, 6> counts_{};
    std::array<std::size_t, 6> offsets_{};  // in bytes
};

}  // namespace mirrorball::gl
