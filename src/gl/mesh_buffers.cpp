#include "mesh_buffers.h"

#include <vector>

#include "check.h"

namespace mirrorball::gl {
namespace {

// Locations in shaders/surface.vert.
enum Attribute : GLuint { kPosition, kNormal, kTextureCoordinate, kSplitPlace, kTangent };

template <class T>
void attach(const Buffer& buffer, Attribute attribute, const std::vector<T>& values) {
    if (values.empty()) return;  // the attribute is then its default, 0
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    fill_buffer(GL_ARRAY_BUFFER, std::span<const T>(values), GL_STATIC_DRAW);
    glEnableVertexAttribArray(attribute);
    glVertexAttribPointer(attribute, sizeof(T) / sizeof(float), GL_FLOAT, GL_FALSE, 0, nullptr);
}

void attach_indices(const Buffer& buffer, const std::vector<std::uint32_t>& indices) {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.name());
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, std::span<const std::uint32_t>(indices), GL_STATIC_DRAW);
}

}  // namespace

MeshBuffers::MeshBuffers(const Mesh& mesh)
    : index_count_(static_cast<GLsizei>(mesh.indices.size())),
      bounds_(mirrorball::bounds(mesh)) {
    glBindVertexArray(array_.name());
    attach(buffers_[0], kPosition, mesh.positions);
    attach(buffers_[1], kNormal, mesh.normals);
    attach(buffers_[2], kTextureCoordinate, mesh.texture_coordinates);
    attach(buffers_[3], kTangent, mesh.tangents);
    attach_indices(buffers_[4], mesh.indices);
    glBindVertexArray(0);
    check("taking a mesh");
}

void MeshBuffers::draw() const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

SplitMeshBuffers::SplitMeshBuffers(const SplitMesh& mesh) {
    glBindVertexArray(array_.name());
    attach(buffers_[0], kPosition, mesh.positions);
    attach(buffers_[1], kNormal, mesh.normals);
    attach(buffers_[2], kSplitPlace, mesh.texture_coordinates);
    std::vector<std::uint32_t> indices;
    for (std::size_t face = 0; face < counts_.size(); ++face) {
        offsets_[face] = indices.size() * sizeof(std::uint32_t);
        counts_[face] = static_cast<GLsizei>(mesh.indices[face].size());
        indices.insert(indices.end(), mesh.indices[face].begin(), mesh.indices[face].end());
    }
    attach_indices(buffers_[3], indices);
    glBindVertexArray(0);
    check("taking a split mesh");
}

void SplitMeshBuffers::draw(int face) const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, counts_[face], GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offsets_[face]));
}

}  // namespace mirrorball::gl
