#include <mirrorball/gl/context.h>

#include <array>
#include <vector>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "gl.h"

namespace mirrorball::gl {
namespace {

constexpr const char* kAdvice =
    "On Debian an OpenGL driver that needs no graphics card comes with: apt-get install "
    "libegl1 libgl1 libgles2 libgl1-mesa-dri";

std::string_view name(Api api) {
    switch (api) {
        case Api::core:
            return "OpenGL 4.5 (core profile)";
        case Api::es:
            return "OpenGL ES 3.0";
        case Api::compatibility:
            return "OpenGL 4.5 (compatibility profile)";
    }
    return {};
}

std::string egl_error() {
    switch (eglGetError()) {
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        default:
            return "no EGL error";
    }
}

[[noreturn]] void refuse(Api api, const std::string& found) {
    throw Error(Errc::unsupported, fmt::format("{} without a window was asked for, but {}. {}",
                                               name(api), found, kAdvice));
}

// Graphics cards first, then Mesa without any; a display that can be initialised.
EGLDisplay open_display(Api api) {
    if (!epoxy_has_egl()) refuse(api, "libEGL.so.1 is not installed");
    const bool has_platforms = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base");
    std::vector<EGLDisplay> candidates;
    if (has_platforms && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
        for (EGLint i = 0; i < count; ++i) {
            candidates.push_back(
                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
        }
    }
    if (has_platforms && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        candidates.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    }
    candidates.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
    for (const EGLDisplay display : candidates) {
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    }
    refuse(api, fmt::format("EGL has no display that works ({})", egl_error()));
}

EGLContext make_context(EGLDisplay display, Api api) {
    eglBindAPI(api == Api::es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
    const bool es = api == Api::es;
    std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION, es ? 3 : 4,
                                      EGL_CONTEXT_MINOR_VERSION, es ? 0 : 5};
    if (!es) {
        attributes.push_back(EGL_CONTEXT_OPENGL_PROFILE_MASK);
        attributes.push_back(api == Api::core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
                                              : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT);
    }
    attributes.push_back(EGL_NONE);
    const EGLContext context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) {
        refuse(api, fmt::format("the driver ({}) makes no such context ({})",
                                eglQueryString(display, EGL_VENDOR), egl_error()));
    }
    return context;
}

}  // namespace

struct Context::Handles {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    Api api = Api::core;
};

Context::Context(Api api) : handles_(std::make_unique<Handles>()) {
    handles_->api = api;
    handles_->display = open_display(api);
    handles_->context = make_context(handles_->display, api);
    make_current();
}

Context::~Context() {
    eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(handles_->display, handles_->context);
}

void Context::make_current() {
    if (!eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context)) {
        refuse(handles_->api,
               fmt::format("its context works with a window only ({})", egl_error()));
    }
}

}  // namespace mirrorball::gl
