// The parsers of mesh files, which are compiled from their headers where their libraries are not.
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Weverything"
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
#pragma clang diagnostic pop
