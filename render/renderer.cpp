#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>

#include "render/channels/gather.h"
#include "render/channels/plate.h"
#include "render/cpu/smoke_march.h"
#include "render/cpu/surfaces.h"
#include "render/gl/read_back.h"
#include "render/image/smooth_edges.h"
#include "render/light/smoke_cache.h"
#include "render/overlay/pass_overlay.h"
#include "render/passes/passes.h"
#include "render/passes/phase_clock.h"
#include "render/passes/slice_passes.h"
#include "render/passes/solid_cache.h"
#include "render/snow/layer.h"

namespace neve::render {
namespace {

void check_mesh(const TriangleMesh& mesh) {
  const std::size_t count = mesh.position.size();
  if (!mesh.normal.empty() && mesh.normal.size() != count)
    throw std::invalid_argument("Frame: a mesh has " + std::to_string(count) + " positions and " +
                                std::to_string(mesh.normal.size()) + " normals");
  for (const std::uint32_t i : mesh.index) {
    if (i >= count)
      throw std::invalid_argument("Frame: a mesh names a vertex that it does not have");
  }
}

void check_smoke(const Smoke& smoke) {
  if (!smoke.nodes) return;
  const std::size_t count = 64 * smoke.nodes->block.size();
  if (smoke.density.size() != count || (!smoke.value.empty() && smoke.value.size() != count))
    throw std::invalid_argument("Frame: smoke on " + std::to_string(count) + " nodes has " +
                                std::to_string(smoke.density.size()) + " densities and " +
                                std::to_string(smoke.value.size()) + " values");
  const auto is_positive = [](float x) { return x > 0 && std::isfinite(x); };
  if (!is_positive(smoke.nodes->spacing) || !is_positive(smoke.full_density) ||
      !(smoke.samples_per_ray >= 0 && smoke.samples_per_ray <= 4))
    throw std::invalid_argument(
        "Frame: smoke needs a positive spacing and full_density, and 0 to 4 samples per ray");
}

void check_plot(const Plot& plot) {
  for (const PlotSeries& series : plot.series) {
    if (series.x.size() != series.value.size())
      throw std::invalid_argument("Frame: a plot has " + std::to_string(series.x.size()) +
                                  " places and " + std::to_string(series.value.size()) + " values");
  }
}

void check_points(std::size_t position, std::initializer_list<std::size_t> others) {
  for (const std::size_t other : others)
    if (other != 0 && other != position)
      throw std::invalid_argument("Frame: " + std::to_string(position) + " points and " +
                                  std::to_string(other) + " ids, values, volumes or turns");
}

void check_frame(const Frame& frame, int max_size) {
  const int largest = std::max(frame.width, frame.height);
  if (frame.width < 1 || frame.height < 1 ||
      (frame.supersampling != 1 && frame.supersampling != 2) ||
      largest > max_size / frame.supersampling)
    throw std::invalid_argument(
        "Frame: " + std::to_string(frame.width) + "x" + std::to_string(frame.height) + " with " +
        std::to_string(frame.supersampling) + " samples per axis; this context draws up to " +
        std::to_string(max_size) + " samples per side, 1 or 2 per pixel");
  const Points& points = frame.points;
  check_points(points.position.size(), {points.id.size(), points.value.size(), points.volume.size(),
                                        points.turn.size(), points.to_solid.size()});
  if (const std::optional<CutAway>& cut = points.cut) {
    check_points(cut->position.size(), {cut->id.size(), cut->value.size(), cut->volume.size(),
                                        cut->turn.size(), cut->to_solid.size()});
    if (!cut->position.empty() &&
        (cut->id.empty() != points.id.empty() || cut->value.empty() != points.value.empty() ||
         cut->volume.empty() != points.volume.empty() || cut->turn.empty() != points.turn.empty() ||
         cut->to_solid.empty() != points.to_solid.empty()))
      throw std::invalid_argument("Frame: points that are cut away have other arrays than points");
  }
  for (const TriangleMesh& mesh : frame.meshes) check_mesh(mesh);
  for (const TriangleMesh& mesh : frame.ghosts) check_mesh(mesh);
  check_smoke(frame.smoke);
  for (const Arrows& arrows : frame.arrows) {
    if (arrows.vector.size() != arrows.position.size())
      throw std::invalid_argument("Frame: " + std::to_string(arrows.position.size()) +
                                  " places for " + std::to_string(arrows.vector.size()) +
                                  " arrows");
  }
  for (const Lines& lines : frame.lines)
    if (!lines.value.empty() && lines.value.size() != lines.ends.size() / 2)
      throw std::invalid_argument("lines have " + std::to_string(lines.ends.size() / 2) +
                                  " pairs of ends, but " + std::to_string(lines.value.size()) +
                                  " values");
  for (const HeatMap& map : frame.heat_maps) {
    if (!map.cover.empty() && map.cover.size() != map.value.size())
      throw std::invalid_argument("a heat map has " + std::to_string(map.cover.size()) +
                                  " covers for " + std::to_string(map.value.size()) + " values");
    if (static_cast<long long>(map.value.size()) !=
        static_cast<long long>(map.columns) * static_cast<long long>(map.rows))
      throw std::invalid_argument("Frame: a heat map has " + std::to_string(map.value.size()) +
                                  " values for " + std::to_string(map.columns) + " columns and " +
                                  std::to_string(map.rows) + " rows");
  }
  for (const Plot& plot : frame.plots) check_plot(plot);
}

/// Automatic remains on a GPU: see Impl::is_on_cpu.
ParticlePath resolve_path(ParticlePath path, const gl::Context& context) {
  if (path != ParticlePath::automatic) return path;
  const char* wanted = std::getenv("NEVE_PARTICLES");
  const std::string name = wanted ? wanted : "";
  if (name == "gl") return ParticlePath::gl;
  if (name == "cpu") return ParticlePath::cpu;
  if (!name.empty()) throw ParticlePathError("NEVE_PARTICLES=" + name + "; expected gl or cpu");
  return context.is_software ? ParticlePath::cpu : ParticlePath::automatic;
}

void check_picture(const Image& picture, const Frame& frame) {
  const std::size_t bytes =
      3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (picture.width != frame.width || picture.height != frame.height || picture.channels != 3 ||
      picture.pixels.size() != bytes)
    throw std::invalid_argument("Renderer: overlays need an RGB picture of the size of the frame");
}

}  // namespace

struct Renderer::Impl {
  gl::Context& context;
  ThreadPool* pool;
  ParticlePath path;
  gl::Gl gl;
  gl::ShaderLibrary library;
  light::Lighting lighting;
  light::SmokeCache smoke_cache;
  passes::GroundPass ground;
  passes::MeshPass meshes;
  passes::ParticlePass particles;
  passes::TilePass tiles;
  cpu::Surfaces surfaces;
  snow::Layer snow_layer;
  cpu::SmokeMarch smoke_march;
  SmoothEdges smooth_edges;
  passes::SolidCache solids;
  passes::SmokePass smoke;
  passes::ArrowPass arrows;
  passes::HeatMapPass heat_maps;
  passes::LinePass lines;
  passes::ShadePass shade;
  passes::ResolvePass resolve;
  overlay::OverlayPass overlay;
  gl::ReadBack read_back;
  std::optional<gl::Targets> targets;

  Impl(gl::Context& c, const std::string& shader_dir, ThreadPool* p, ParticlePath wanted,
       ReadBackWay way)
      : context(c),
        pool(p),
        path(resolve_path(wanted, c)),
        gl(gl::load_gl(c)),
        library(shader_dir),
        ground(gl, library),
        meshes(gl, library),
        particles(gl, library, c.is_software),
        tiles(gl, library),
        surfaces(p),
        smoke_march(p),
        smoke(gl, library),
        arrows(gl, library),
        heat_maps(gl, library),
        lines(gl, library),
        shade(gl, library),
        resolve(gl, library),
        overlay(gl, library),
        read_back(gl,
                  way == ReadBackWay::automatic ? !c.is_software : way == ReadBackWay::buffered) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  /// The members delete OpenGL names, so the context has to be ours again.
  ~Impl() { context.make_current(); }

  int max_size() const {
    GLint texture = 0, viewport[2] = {0, 0};
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    gl.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return std::min({texture, viewport[0], viewport[1]});
  }

  /// The processor makes the surface of snow whatever the path; where it may choose it shades it,
  /// too, as handing it to a GPU sample by sample takes longer.
  bool is_on_cpu(const Frame& frame) const {
    return path == ParticlePath::cpu || (path == ParticlePath::automatic && frame.has_snow_surface);
  }

  void prepare_targets(const Frame& frame) {
    const bool has_samples =
        frame.supersampling > 1 || (frame.has_smooth_edges && !is_on_cpu(frame));
    if (targets && targets->width == frame.width && targets->height == frame.height &&
        targets->supersampling == frame.supersampling && targets->has_samples == has_samples)
      return;
    targets.reset();  // frees the memory before the new ones take theirs
    targets.emplace(gl, frame.width, frame.height, frame.supersampling, has_samples);
  }

  void bind(const gl::Framebuffer& framebuffer, int width, int height) const {
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.Viewport(0, 0, width, height);
    gl.Disable(GL_SCISSOR_TEST);
  }

  void clear_gbuffer() const {
    const GLfloat nothing[4] = {0, 0, 0, 0}, far_away = 1;
    gl.DepthMask(GL_TRUE);
    gl.ClearBufferfv(GL_COLOR, 0, nothing);
    gl.ClearBufferfv(GL_COLOR, 1, nothing);
    gl.ClearBufferfv(GL_DEPTH, 0, &far_away);
  }

  /// The finished picture, at once.
  Image take(const Frame& frame) {
    read_back.begin(frame.width, frame.height, frame.is_transparent);
    return read_back.finish_newest();
  }

  Image draw_over(const Image& picture, const Frame& frame) {
    context.make_current();
    check_frame(frame, max_size());
    check_picture(picture, frame);
    prepare_targets(frame);
    upload_picture(picture);
    bind(targets->finished, frame.width, frame.height);
    overlay.draw(frame, make_view(frame.camera, frame.width, frame.height));
    return take(frame);
  }

  void upload_picture(const Image& picture) {
    const auto row = 3 * static_cast<std::size_t>(picture.width);
    std::vector<std::uint8_t> upside_down(picture.pixels.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y)
      std::copy_n(picture.pixels.data() + row * y, row,
                  upside_down.data() + row * (static_cast<std::size_t>(picture.height) - 1 - y));
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.BindTexture(GL_TEXTURE_2D, targets->picture.id());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGB,
                  GL_UNSIGNED_BYTE, upside_down.data());
  }

  Image draw(const Frame& frame, std::vector<PhaseTime>* times) {
    passes::PhaseClock clock(gl, times);
    draw_into_targets(frame, clock);
    Image image = take(frame);
    clock.end("read_back");
    return image;
  }

  void paint(const Frame& frame) {
    passes::PhaseClock clock(gl, nullptr);
    draw_into_targets(frame, clock);
  }

  void copy_picture(GLuint framebuffer, int x, int y, int width, int height) const {
    if (!targets) return;
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, targets->finished.id());
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    gl.Disable(GL_SCISSOR_TEST);
    const bool is_same = width == targets->width && height == targets->height;
    gl.BlitFramebuffer(0, 0, targets->width, targets->height, x, y, x + width, y + height,
                       GL_COLOR_BUFFER_BIT, is_same ? GL_NEAREST : GL_LINEAR);
  }

  void submit(const Frame& frame) {
    paint(frame);
    read_back.begin(frame.width, frame.height, frame.is_transparent);
  }

  void draw_into_targets(const Frame& frame, passes::PhaseClock& clock) {
    context.make_current();
    check_frame(frame, max_size());
    prepare_targets(frame);
    const light::SmokeGrid& smoke_grid = smoke_cache.grid(frame.smoke, pool);
    const light::LightVolume& light = lighting.volume(frame, smoke_grid, pool);
    clock.end("light");

    const View view = make_view(frame.camera, targets->sample_width(), targets->sample_height());
    if (is_on_cpu(frame))
      draw_on_cpu(frame, view, smoke_grid, light, clock);
    else
      draw_by_gl(frame, view, smoke_grid, light, clock);

    if (targets->has_samples && frame.supersampling == 1) finish_samples(frame);
    bind(targets->laid_over_with_depth, view.width, view.height);
    ground.draw_ghosts(frame, view);
    meshes.draw_ghosts(frame.ghosts, light::toward_light(frame.light), view);
    bind(targets->laid_over, view.width, view.height);
    lines.draw(frame.lines, *targets, view, static_cast<float>(frame.supersampling));

    if (frame.supersampling > 1) finish_samples(frame);
    bind(targets->finished, frame.width, frame.height);
    clock.end("shade");
    overlay.draw(frame, make_view(frame.camera, frame.width, frame.height));
    clock.end("overlay");
  }

  void finish_samples(const Frame& frame) {
    bind(targets->finished, frame.width, frame.height);
    resolve.draw(*targets);
  }

  void draw_by_gl(const Frame& frame, const View& view, const light::SmokeGrid& smoke_grid,
                  const light::LightVolume& light, passes::PhaseClock& clock) {
    bind(targets->gbuffer, view.width, view.height);
    clear_gbuffer();
    if (frame.has_snow_surface) {
      prepare_surfaces(frame, view, light);
      surfaces.keep_points();
      tiles.draw(surfaces.kept(), surfaces.columns(), view);
    } else {
      particles.draw(frame.points, view, pool);
    }
    clock.end("particles");
    ground.draw(frame, view);
    meshes.draw(frame.meshes, view);
    clock.end("solids");
    draw_slices(frame, view);
    clock.end("slices");
    std::optional<passes::SmokePicture> smoke_picture;
    if (!smoke_grid.is_empty())
      smoke_picture = smoke.draw(frame.smoke, smoke_grid,
                                 smoke_cache.volume(light, light::toward_light(frame.light), pool),
                                 frame.light, *targets, view);
    clock.end("smoke");
    bind(targets->shaded, view.width, view.height);
    shade.draw(*targets, light, frame, view, smoke_picture ? &*smoke_picture : nullptr);
  }

  void prepare_surfaces(const Frame& frame, const View& view, const light::LightVolume& light) {
    if (frame.has_snow_surface) {
      snow_layer.prepare(frame, view, light, pool);
      surfaces.prepare(frame, view, snow_layer.spray(), &snow_layer);
    } else {
      surfaces.prepare(frame, view, frame.points);
    }
  }

  void draw_slices(const Frame& frame, const View& view) {
    heat_maps.draw(frame.heat_maps, view, static_cast<float>(frame.supersampling));
    arrows.draw(frame.arrows, view);
  }

  void draw_on_cpu(const Frame& frame, const View& view, const light::SmokeGrid& smoke_grid,
                   const light::LightVolume& light, passes::PhaseClock& clock) {
    // Kept where smoke ends at them, and where each step is timed.
    const bool is_kept = clock.is_wanted() || !smoke_grid.is_empty();
    const std::optional<light::SmokeCover> cover =
        draw_surfaces(frame, view, smoke_grid, light, is_kept, clock);
    const bool wants_depth =
        !frame.ghosts.empty() || !frame.ghost_grounds.empty() || !frame.lines.empty();
    surfaces.shade(light, cover ? &*cover : nullptr, wants_depth);
    upload_surfaces(view, wants_depth, frame.has_smooth_edges && frame.supersampling == 1);
  }

  /// Everything before the light: the surfaces, and the smoke before them.
  std::optional<light::SmokeCover> draw_surfaces(const Frame& frame, const View& view,
                                                 const light::SmokeGrid& smoke_grid,
                                                 const light::LightVolume& light, bool is_kept,
                                                 passes::PhaseClock& clock,
                                                 bool has_parts = false) {
    prepare_surfaces(frame, view, light);
    if (is_kept) surfaces.keep_points(has_parts);
    clock.end("particles");
    if (is_kept) surfaces.keep_grounds();
    const bool has_solids =
        !frame.meshes.empty() || !frame.heat_maps.empty() || !frame.arrows.empty();
    const bool is_drawn = has_solids && !solids.holds(frame, view);
    if (is_drawn) {
      bind(targets->gbuffer, view.width, view.height);
      clear_gbuffer();
      meshes.draw(frame.meshes, view);
    }
    clock.end("solids");
    if (is_drawn) {
      draw_slices(frame, view);
      read_solids(solids.renew(frame, view));
    }
    if (has_solids) surfaces.set_solids(&solids.samples());
    if (is_kept) surfaces.keep_solids();
    clock.end("slices");
    std::optional<light::SmokeCover> cover;
    if (!smoke_grid.is_empty())
      cover = smoke_march.march(frame.smoke, smoke_grid,
                                smoke_cache.volume(light, light::toward_light(frame.light), pool),
                                frame.light, surfaces, view);
    clock.end("smoke");
    return cover;
  }

  /// Surfaces, light and smoke of a frame on the CPU, kept for whoever reads them.
  template <class Read>
  void with_lit_surfaces(const Frame& frame, const View& view, const Read& read) {
    const light::SmokeGrid& smoke_grid = smoke_cache.grid(frame.smoke, pool);
    const light::LightVolume& light = lighting.volume(frame, smoke_grid, pool);
    passes::PhaseClock clock(gl, nullptr);
    const std::optional<light::SmokeCover> cover =
        draw_surfaces(frame, view, smoke_grid, light, true, clock, true);
    read(channels::LitSurfaces{frame, surfaces, light, cover ? &*cover : nullptr});
  }

  ExrPicture draw_channels(const Frame& frame, const channels::Request& request) {
    context.make_current();
    check_frame(frame, max_size());
    channels::check_request(frame, request);
    prepare_targets(frame);
    const auto view_of = [&](const Frame& f) {
      return make_view(f.camera, targets->sample_width(), targets->sample_height());
    };
    channels::LightPlanes light;
    const Moments& moments = request.moments;
    for (int k = 0; k < moments.count; ++k) {
      const Frame moment = moments.at(k);
      channels::check_moment(frame, moment);
      with_lit_surfaces(moment, view_of(moment), [&](const channels::LitSurfaces& lit) {
        channels::add_light(lit, request, 1 / static_cast<float>(moments.count), light);
      });
    }
    channels::DataPlanes data;
    const View view = view_of(frame);
    with_lit_surfaces(frame, view, [&](const channels::LitSurfaces& lit) {
      if (moments.count == 0) channels::add_light(lit, request, 1, light);
      const std::optional<cpu::SolidSamples> meshes = draw_mesh_numbers(frame, view);
      data = channels::gather_data(lit, request, view, meshes ? &*meshes : nullptr, pool);
    });
    return channels::to_picture(frame.width, frame.height, request, std::move(light),
                                std::move(data));
  }

  Image draw_on_plate(const Frame& frame, const Image& plate) {
    context.make_current();
    check_frame(frame, max_size());
    check_picture(plate, frame);
    prepare_targets(frame);
    const View view = make_view(frame.camera, targets->sample_width(), targets->sample_height());
    Frame drawn = frame;
    drawn.is_transparent = true;
    // All grounds of a plate take shadows only.
    for (GroundPlane& ground : drawn.grounds) ground.is_holdout = false;
    cpu::LinearSamples shadow, front;
    with_lit_surfaces(drawn, view, [&](const channels::LitSurfaces& lit) {
      shadow = channels::ground_shadow(lit);
      // They still hide what is below them.
      surfaces.uncover_grounds();
      lit.surfaces.shade_linear(lit.light, lit.smoke, {}, front);
    });
    Frame words = frame;
    words.is_transparent = false;
    return draw_over(channels::lay_over_plate(front, shadow, frame, plate), words);
  }

  /// The number of the mesh that each sample shows, in three bytes of the albedo.
  std::optional<cpu::SolidSamples> draw_mesh_numbers(const Frame& frame, const View& view) {
    if (frame.meshes.empty()) return std::nullopt;
    std::vector<TriangleMesh> numbered = frame.meshes;
    for (std::size_t m = 0; m < numbered.size(); ++m) {
      // The G-buffer holds square roots.
      const auto byte = [&](std::size_t shift) {
        const auto share = static_cast<float>(m >> shift & 0xff) / 255;
        return share * share;
      };
      numbered[m].color = {byte(0), byte(8), byte(16)};
    }
    bind(targets->gbuffer, view.width, view.height);
    clear_gbuffer();
    meshes.draw(numbered, view);
    std::optional<cpu::SolidSamples> samples(std::in_place);
    samples->resize(view.width, view.height);
    read_solids(*samples);
    return samples;
  }

  /// The G-buffer as OpenGL has it.
  void read_solids(cpu::SolidSamples& samples) {
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    const auto read = [&](GLenum buffer, GLenum format, GLenum type, void* to) {
      gl.ReadBuffer(buffer);
      gl.ReadPixels(0, 0, samples.width, samples.height, format, type, to);
    };
    read(GL_COLOR_ATTACHMENT0, GL_DEPTH_COMPONENT, GL_FLOAT, samples.depth.data());
    read(GL_COLOR_ATTACHMENT0, GL_RGBA, GL_HALF_FLOAT, samples.normal_kind.data());
    read(GL_COLOR_ATTACHMENT1, GL_RGBA, GL_UNSIGNED_BYTE, samples.albedo.data());
  }

  void upload_surfaces(const View& view, bool has_depth, bool is_smooth) {
    gl.ActiveTexture(GL_TEXTURE0);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.PixelStorei(GL_UNPACK_ROW_LENGTH, surfaces.pitch());
    const auto upload = [&](const gl::Texture& texture, GLenum format, GLenum type,
                            const void* from) {
      gl.BindTexture(GL_TEXTURE_2D, texture.id());
      gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, view.width, view.height, format, type, from);
    };
    const std::uint32_t* picture = surfaces.picture();
    if (is_smooth) {
      picture = smooth_edges.of(picture, surfaces.pitch(), view.width, view.height, pool);
      gl.PixelStorei(GL_UNPACK_ROW_LENGTH, view.width);
    }
    upload(targets->top(), GL_RGBA, GL_UNSIGNED_BYTE, picture);
    gl.PixelStorei(GL_UNPACK_ROW_LENGTH, surfaces.pitch());
    if (has_depth) upload(targets->depth, GL_DEPTH_COMPONENT, GL_FLOAT, surfaces.depth());
    gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  }
};

Renderer::Renderer(gl::Context& context, const std::string& shader_dir, ThreadPool* pool,
                   ParticlePath path, ReadBackWay read_back) {
  context.make_current();
  impl_ = std::make_unique<Impl>(context, shader_dir, pool, path, read_back);
}

Renderer::~Renderer() = default;

Image Renderer::draw(const Frame& frame, std::vector<PhaseTime>* times) {
  return impl_->draw(frame, times);
}

ExrPicture Renderer::draw_channels(const Frame& frame, const channels::Request& request) {
  return impl_->draw_channels(frame, request);
}

Image Renderer::draw_on_plate(const Frame& frame, const Image& plate) {
  return impl_->draw_on_plate(frame, plate);
}

void Renderer::submit(const Frame& frame) {
  impl_->submit(frame);
}

void Renderer::paint(const Frame& frame) {
  impl_->paint(frame);
}

void Renderer::copy_picture(unsigned framebuffer, int x, int y, int width, int height) {
  impl_->context.make_current();
  impl_->copy_picture(framebuffer, x, y, width, height);
}

std::size_t Renderer::pending() const {
  return impl_->read_back.pending();
}

Image Renderer::fetch() {
  impl_->context.make_current();
  return impl_->read_back.finish_oldest();
}

ParticlePath Renderer::particle_path() const {
  return impl_->path == ParticlePath::cpu ? ParticlePath::cpu : ParticlePath::gl;
}

Image Renderer::draw_over(const Image& picture, const Frame& frame) {
  return impl_->draw_over(picture, frame);
}

int Renderer::max_size() const {
  impl_->context.make_current();
  return impl_->max_size();
}

}  // namespace neve::render
