// OpenGL and EGL: every file here that calls them includes this one, so a build for another loader
// has one place to change.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>
