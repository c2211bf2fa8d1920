#pragma once
#include <mirrorball/image.h>
namespace mirrorball {
struct SurfaceBuffer { Image position, normal, object, texture_coordinates; };
}
