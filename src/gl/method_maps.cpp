#include "method_maps.h"

#include <algorithm>
#include <cmath>

#include <mirrorball/projections/cube.h>

namespace mirrorball::gl {
namespace {

// A method's textures: what kind, how many layers, and how large next to a cube's face, so that
// there are as many texels to a degree.
struct Form {
    GLenum target;
    int layer_count, widths, heights;
    Warp::Shape first_shape;
};

Form form_of(Method method) {
    switch (projection_of(method)) {
        case Projection::sphere:
            return {GL_TEXTURE_2D, 1, 2, 2, Warp::Shape::sphere};
        case Projection::dual_paraboloid:
            return {GL_TEXTURE_2D_ARRAY, 2, 2, 2, Warp::Shape::front_paraboloid};
        case Projection::equirect:
            return {GL_TEXTURE_2D, 1, 4, 2, Warp::Shape::equirect};
        case Projection::octahedral:
            return {GL_TEXTURE_2D, 1, 2, 2, Warp::Shape::octahedral};
        default:
            return {GL_TEXTURE_2D_ARRAY, Cube::face_count, 1, 1, Warp::Shape::face};
    }
}

// All that there can be, if the cube has any.
int mip_level_count(const Form& form, const Texture& cube) {
    const int largest = std::max(form.widths, form.heights) * cube.width;
    return cube.level_count == 1 ? 1 : 1 + static_cast<int>(std::log2(largest));
}

// Nothing for what is not there.
Texture room(const Form& form, const Texture& cube, int level_count) {
    if (cube.empty()) return {};
    Texture texture = make_texture(form.target, form.widths * cube.width, form.heights * cube.width,
                                   level_count, form.layer_count);
    if (form.first_shape == Warp::Shape::equirect)
        glTexParameteri(form.target, GL_TEXTURE_WRAP_S, GL_REPEAT);
    return texture;
}

std::vector<Texture> faces_room(const Texture& cube) {
    std::vector<Texture> faces;
    if (cube.empty()) return faces;
    for (int i = 0; i < Cube::face_count; ++i)
        faces.push_back(make_texture(GL_TEXTURE_2D, cube.width, cube.width, cube.level_count));
    return faces;
}

void make_levels(const Texture& texture) {
    if (texture.level_count == 1) return;
    texture.bind(0);
    glGenerateMipmap(texture.target);
}

}  // namespace

bool MethodMaps::needed_for(Method method) {
    return method != Method::cube && method != Method::cube_vertex;
}

MethodMaps::MethodMaps(Method method, const MapTextures& cubes)
    : method_(method),
      axes_(default_axes(projection_of(method))) {
    if (method == Method::cube_split) {
        textures_.mirror_faces = faces_room(cubes.mirror);
        for (const Texture& cube : cubes.glossy) textures_.glossy_faces.push_back(faces_room(cube));
        return;  // what is looked up by the normal stays a cube
    }
    const Form form = form_of(method);
    textures_.mirror = room(form, cubes.mirror, mip_level_count(form, cubes.mirror));
    for (const Texture& cube : cubes.glossy) textures_.glossy.push_back(room(form, cube, 1));
    textures_.diffuse = room(form, cubes.diffuse, 1);
    textures_.rough = room(form, cubes.rough, cubes.rough.level_count);
}

template <class WarpLayer>
void MethodMaps::for_each_layer(WarpLayer&& warp_layer) {
    const Form form = form_of(method_);
    for (int layer = 0; layer < form.layer_count; ++layer) {
        const bool back = form.first_shape == Warp::Shape::front_paraboloid && layer == 1;
        warp_layer(back ? Warp::Shape::back_paraboloid : form.first_shape, layer);
    }
}

void MethodMaps::make(const Texture& cube, const Texture& into) {
    if (into.empty()) return;
    for_each_layer([&](Warp::Shape shape, int layer) {
        warp_(cube, made_->cube_axes, shape, made_->frame, into, layer, layer);
    });
    make_levels(into);
}

// Its levels are not each other's means: each is made of the cube's own.
void MethodMaps::make_rough(const Texture& cube) {
    for_each_layer([&](Warp::Shape shape, int layer) {
        for (int level = 0; level < textures_.rough.level_count; ++level)
            warp_.level(level, cube, made_->cube_axes, shape, made_->frame, textures_.rough, layer,
                        layer);
    });
}

void MethodMaps::make_faces(const Texture& cube, const Axes& cube_axes,
                            const std::vector<Texture>& into) {
    for (std::size_t face = 0; face < into.size(); ++face) {
        warp_(cube, cube_axes, Warp::Shape::face, axes_, into[face], 0, static_cast<int>(face));
        make_levels(into[face]);
    }
}

void MethodMaps::make(const MapTextures& cubes, const Axes& cube_axes, const Axes& camera) {
    if (method_ == Method::cube_split) {
        make_faces(cubes.mirror, cube_axes, textures_.mirror_faces);
        for (std::size_t i = 0; i < cubes.glossy.size(); ++i)
            make_faces(cubes.glossy[i], cube_axes, textures_.glossy_faces[i]);
        return;
    }
    made_ = Made{cube_axes, axes_};
    if (projection_of(method_) == Projection::sphere) {
        // GL_SPHERE_MAP works in the eye's frame whatever the map was made for.
        axes_ = camera;
        made_->frame = method_ == Method::sphere_stale ? Axes{} : camera;
    }
    make(cubes.mirror, textures_.mirror);
    for (std::size_t i = 0; i < cubes.glossy.size(); ++i)
        make(cubes.glossy[i], textures_.glossy[i]);
    make(cubes.diffuse, textures_.diffuse);
    if (!textures_.rough.empty()) make_rough(cubes.rough);
}

void MethodMaps::add_glossy(const Texture& cube) {
    textures_.glossy.push_back(room(form_of(method_), cube, 1));
    if (made_) make(cube, textures_.glossy.back());
}

void MethodMaps::remove_glossy(std::size_t lobe) {
    textures_.glossy.erase(textures_.glossy.begin() + static_cast<std::ptrdiff_t>(lobe));
}

}  // namespace mirrorball::gl
