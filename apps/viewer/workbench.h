// The viewer without its window: what is open, seen and painted, and what each input does.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/explain_pixel.h"
#include "viewer/denoised_preview.h"
#include "viewer/display_table.h"
#include "viewer/document.h"
#include "viewer/file_watch.h"
#include "viewer/input_event.h"
#include "viewer/navigation.h"
#include "viewer/orbit_camera.h"
#include "viewer/painter.h"
#include "viewer/picture_view.h"
#include "viewer/render_loop.h"
#include "viewer/timeline.h"
#include "viewer/user_state.h"

namespace relief::viewer {

enum class Tool { look, paint };

/// Where the picture lies in the window, pixels.
struct ViewArea {
    float x = 0, y = 0, width = 1, height = 1;
};

class Workbench {
  public:
    /// `settings`: of the pictures; their layers are those of the viewer. `given`: what of the picture a
    /// scene file must not change. `on_news` is called by other threads when update() has something to do.
    /// `state_folder`: of what is kept between two runs; empty: nothing is.
    Workbench(const RenderSettings& settings, const PictureDefaults& given,
              std::function<void()> on_news = {}, const std::filesystem::path& state_folder = {});
    ~Workbench();

    // Files. Errors become messages.
    void open(const SceneInput& input);
    bool is_loading() const { return loading_.valid(); }
    /// Why the file that was opened last could not be read; empty: it was.
    const std::string& load_error() const { return load_error_; }
    /// Throws Error{bad_input} with load_error() where nothing else is open.
    void refuse_nothing_open() const;
    /// Dropped files: a scene or mesh is opened, with the map and the HDR that come with it; a map alone goes
    /// onto the mesh that is open, an HDR becomes the environment.
    void drop(const std::vector<std::filesystem::path>& files);
    /// What a user wants to open: at once, or, where something is not saved, once open_asked() is called.
    void ask_to_open(const std::vector<std::filesystem::path>& files);
    bool is_asked_to_open() const { return !asked_files_.empty(); }
    /// What is not saved may go, once another scene has come.
    void open_asked() { open_files(std::exchange(asked_files_, {}), true); }
    void forget_asked() { asked_files_.clear(); }
    bool save(const std::filesystem::path& file);
    /// What is not saved is not kept at the end, either.
    void discard();
    /// In the convention of a preset (conventions.h); empty: in that which the map has.
    bool save_map(size_t displacement, const std::filesystem::path& file, const std::string& preset = {});
    std::vector<std::filesystem::path> list_recent() const { return state_.read_recent(); }
    /// Beside the scene or mesh, with `-view` in its name; of a picture, `.exr`, with the frame's number.
    std::filesystem::path suggest_file(const char* extension) const;
    /// Writes the picture, with its layers where it is an .exr, once it has all samples; at another frame it
    /// is not written. Pauses.
    void write_picture(const std::filesystem::path& file);
    /// What F12 writes: the name, empty for suggest_file(".exr"), and header entries of the picture, which
    /// say how a .png of it looks.
    void set_output(std::string name, std::map<std::string, std::string> metadata) {
        output_name_ = std::move(name), output_metadata_ = std::move(metadata);
    }
    /// As F12.
    void write_picture() {
        write_picture(output_name_.empty() ? suggest_file(".exr") : std::filesystem::path(output_name_));
    }

    // Input and time.
    void set_area(const ViewArea& area) { area_ = area; }
    void set_picture_size(int width, int height);
    void handle(const InputEvent& event);
    /// `now`: seconds of any clock that goes on. True where there is something new to draw.
    bool update(double now);
    bool wants_to_end() const { return wants_to_end_; }
    void set_wants_to_end(bool wants_to_end) { wants_to_end_ = wants_to_end; }
    /// Something was changed or painted, at any frame, since the scene was saved.
    bool has_unsaved() const;
    bool is_help_shown() const { return is_help_shown_; }
    void show_help(bool is_shown) { is_help_shown_ = is_shown; }
    /// Something moves by itself: update() is to be called soon again.
    bool is_moving() const;

    // What is open and how it is seen.
    Document* document() { return document_.get(); }
    const Document* document() const { return document_.get(); }
    const OrbitCamera& camera() const { return camera_; }
    void change_camera(const std::function<void(OrbitCamera&)>& change);
    void frame_all();
    /// The selected object alone; all where none is.
    void frame_selected();
    /// Index into the scene's objects; nothing: none.
    const std::optional<uint32_t>& selected_object() const { return selected_object_; }
    void select(std::optional<uint32_t> object);
    /// Of a scene that differs from frame to frame: the one that is open. Nothing: there are none.
    std::optional<int> frame() const;
    /// The one that is being read, else frame().
    std::optional<int> wanted_frame() const { return wanted_frame_ ? wanted_frame_ : frame(); }
    const Timeline& timeline() const { return timeline_; }
    /// Shows another one once it was read; one that is wanted later takes its place. What was changed stays
    /// so; the camera is that of the scene as long as nobody moved it. False without frames.
    bool show_frame(int frame);
    /// The next one in this direction, +1 or -1; the first or last one.
    void step_frame(int direction);
    void show_end_frame(int direction);
    /// In time, as often as pictures come; frames that come late are left out.
    void set_playing(bool is_playing);
    /// Somebody moved the camera: it stays at other frames.
    bool has_own_camera() const { return has_own_camera_; }
    /// Looks by the camera of the scene again.
    void take_scene_camera();
    /// Whether Open Image Denoise is there, as far as is known: it is looked for once a picture is done.
    bool has_denoiser() const { return preview_.is_there(); }
    bool is_denoised() const { return is_denoised_; }
    /// False, with a message, where the library cannot be loaded.
    bool set_denoised(bool is_denoised);
    const RenderSettings& settings() const { return settings_; }
    void change_settings(const std::function<void(RenderSettings&)>& change);
    /// Calls `change`, shows what came of it, and reports errors as messages.
    void change_document(const std::function<void(Document&)>& change);
    /// The same of how a map is meant, a material, the environment or a light, which undo() takes back;
    /// changes of one within a second count as one.
    void change_displacement(size_t index, const std::function<void(Displacement&)>& change);
    void change_material(size_t index, const std::function<void(Material&)>& change);
    void change_environment(const std::function<void(Environment&)>& change);
    void change_light(size_t index, const std::function<void(Light&)>& change);
    Brush& brush() { return brush_; }
    Tool tool() const { return tool_; }
    void set_tool(Tool tool);
    NavigationPreset& navigation() { return navigation_; }
    bool can_undo() const { return painter_ && painter_->can_undo(); }
    bool can_redo() const { return painter_ && painter_->can_redo(); }
    void undo();
    void redo();
    void explain(float x, float y); ///< pixel of the whole picture

    // What there is to see.
    const std::shared_ptr<const ShownPicture>& picture() const { return picture_; }
    /// The same; without noise where that is wanted and done.
    const std::shared_ptr<const ShownPicture>& shown_picture() const;
    RenderState render_state() const { return loop_.state(); }
    /// A picture of the newest state is shown; and one with all its samples, denoised if that is wanted.
    bool is_shown() const;
    bool is_done() const;
    const std::string& message() const { return message_; }
    /// The last ones, the newest first.
    const std::deque<std::string>& messages() const { return messages_; }
    /// Of the pixel that was clicked on; without text: none.
    const cli::PixelExplanation& explanation() const { return explanation_; }
    /// Of the pixel that was explained, pixels of the whole picture; nothing: none.
    const std::optional<Vec2f>& explained_pixel() const { return explained_pixel_; }
    bool is_explaining() const { return explaining_.valid(); }
    double time_of_first_picture() const { return first_picture_time_; } ///< of update(); below 0: not yet

  private:
    struct Load {
        SceneInput input;
        bool keeps_camera = false, has_dropped_map = false;
        bool discards = false; ///< what was painted before and is not saved
    };
    struct Loaded {
        Load of;
        std::optional<LoadedInput> loaded;
        std::string error;
    };
    struct ReadFrame {
        std::shared_ptr<ShotReader> shot;
        int number = 1;
        std::optional<ShotFrame> frame;
        std::string error;
    };
    struct RereadMap {
        size_t displacement = 0;
        int udim = 1001;
        Texture texels;
    };
    struct Reread {
        uint64_t scene_count = 0; ///< of the document that they belong to
        std::vector<RereadMap> maps;
        std::string error;
    };
    struct Drag {
        DragAction action = DragAction::none;
        MouseButton button = MouseButton::left;
        float start_x = 0, start_y = 0, x = 0, y = 0;
        bool has_moved = false;
    };

    /// `change` returns what it changed, as it was; nothing: it changed nothing.
    void change_value(const std::function<std::optional<SceneValue>(Document&)>& change);
    void frame(const std::optional<uint32_t>& object);
    void forget_explanation();
    bool has_edits() const; ///< has_unsaved(), beside the map that was dropped
    void open_files(const std::vector<std::filesystem::path>& files, bool discards);
    void open_alone(const std::filesystem::path& file, bool discards);
    void load(Load load);
    /// The same file again, by the same camera.
    void read_again() { load({document_->input(), true, has_dropped_map_}); }
    void start(Load load);
    void adopt(Loaded loaded);
    void adopt(Reread reread);
    void adopt(ReadFrame read);
    void poll_frames();
    void read_frame();
    void tell_strokes(int left_frame, const FrameStrokes& strokes);
    /// A picture of the frame that is shown, by any camera, or none of it is to come.
    bool has_picture() const;
    void watch_files();
    void reload(const std::vector<std::filesystem::path>& files);
    void reread(const std::vector<std::filesystem::path>& maps);
    void poll_jobs();
    void note_message();
    /// A user does something: what the last action led to is told no more.
    void end_message();
    void take_picture();
    void take_denoised();
    SessionUse choose_use() const;
    void request(std::vector<MapEdit> edits = {});
    void set_motion(Motion motion);
    void send(std::vector<MapEdit> edits);
    void take_step(const std::function<std::vector<MapEdit>()>& step);
    void fly(double seconds);
    void press(const InputEvent& event);
    void move(const InputEvent& event);
    void drag_to(const InputEvent& event);
    void release(const InputEvent& event);
    void press_key(const InputEvent& event);
    bool press_command(int key);
    bool press_frame_key(const InputEvent& event);
    void drop_output(const char* reason);
    void finish_output();
    Vec2f to_picture(float x, float y) const; ///< pixels of the whole picture
    /// Runs `body`; an exception becomes a message. Returns whether there was none.
    bool attempt(const std::function<void()>& body);
    template <class Result> static bool is_ready(const std::future<Result>& job) {
        return job.valid() && job.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }

    RenderSettings settings_;
    PictureDefaults given_;
    std::function<void()> on_news_;
    std::unique_ptr<Document> document_;
    std::unique_ptr<Painter> painter_;
    OrbitCamera camera_{Camera()};
    Brush brush_;
    Tool tool_ = Tool::look;
    NavigationPreset navigation_ = NavigationPreset::blender;
    ViewArea area_;
    Drag drag_;
    std::set<int> held_keys_;
    Modifiers modifiers_;

    std::shared_ptr<ShotReader> shot_; ///< null: the scene is the same at all frames; used by one job alone
    Timeline timeline_;
    std::optional<int> wanted_frame_; ///< to be read and shown
    int reading_number_ = 1;          ///< of the frame that is being read
    bool has_new_frame_ = true;       ///< none was requested of it
    uint64_t frame_version_ = 0;      ///< of the first request of the frame that is shown
    Camera scene_camera_;
    bool has_own_camera_ = false; ///< somebody moved it
    bool has_dropped_map_ = false, is_discarded_ = false;

    std::shared_ptr<const SharedScene> snapshot_;
    uint64_t snapshot_version_ = 0;
    uint64_t scene_count_ = 0; ///< documents opened: versions of different ones differ
    bool needs_snapshot_ = true, needs_request_ = false;
    bool has_changed_ = false; ///< something that is seen, since the last request
    Motion motion_ = Motion::still;
    double now_ = 0, last_motion_ = 0, last_poll_ = 0, first_picture_time_ = -1, last_change_ = -1;
    uint64_t wanted_version_ = 0;
    std::shared_ptr<const ShownPicture> picture_;
    std::shared_ptr<const ShownPicture> denoised_; ///< of the same version; null: none
    bool is_denoised_ = false;
    std::vector<std::filesystem::path> asked_files_;
    std::string output_name_;
    std::map<std::string, std::string> output_metadata_;
    std::filesystem::path output_; ///< a picture to write when it is done; empty: none
    std::string message_, last_error_, load_error_;
    std::string passing_message_; ///< one that the next action ends, where it is still shown
    std::string strokes_message_; ///< that strokes of other frames are not saved; likewise, once they are
    std::deque<std::string> messages_;
    cli::PixelExplanation explanation_;
    std::optional<Vec2f> explained_pixel_;
    std::optional<uint32_t> selected_object_;
    bool wants_to_end_ = false, is_help_shown_ = false, has_news_ = true;

    FileWatch watch_;
    UserState state_;
    std::future<Loaded> loading_;
    std::optional<Load> next_load_; ///< asked for while another one goes on, whose scene is dropped
    std::future<Reread> rereading_;
    std::future<ReadFrame> reading_frame_;
    std::future<cli::PixelExplanation> explaining_;
    DenoisedPreview preview_;
    RenderLoop loop_; ///< last: its thread calls on_news_
};

} // namespace relief::viewer
