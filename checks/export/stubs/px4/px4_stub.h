/* Not PX4's headers: our own declarations of the public names that the page export-px4.md uses. */
#pragma once
#include <cstdint>
#define MODULE_NAME "fspid_pitch"
#define PX4_OK 0
#define PX4_ERROR (-1)
#define __EXPORT
#define ORB_ID(name) ORB_ID_##name
#define PRINT_MODULE_DESCRIPTION(text) ((void)(text))
#define PRINT_MODULE_USAGE_NAME(name, category) ((void)(name), (void)(category))
#define PRINT_MODULE_USAGE_COMMAND(name) ((void)(name))
#define PRINT_MODULE_USAGE_DEFAULT_COMMANDS() ((void)0)
#define PX4_WARN(...) ((void)0)
enum Topic { ORB_ID_vehicle_attitude, ORB_ID_vehicle_attitude_setpoint, ORB_ID_vehicle_angular_velocity, ORB_ID_debug_vect };
struct vehicle_attitude_s { float q[4]; };
struct vehicle_attitude_setpoint_s { float q_d[4]; };
struct vehicle_angular_velocity_s { float xyz[3]; };
struct debug_vect_s { uint64_t timestamp; char name[10]; float x, y, z; };
uint64_t hrt_absolute_time();
namespace uORB {
class Subscription { public: explicit Subscription(Topic); template <class T> bool copy(T *) { return true; } };
template <class T> class Publication { public: explicit Publication(Topic); bool publish(const T &); };
}
namespace px4 {
struct wq_config_t {};
namespace wq_configurations { extern const wq_config_t nav_and_controllers; }
class ScheduledWorkItem {
public:
    ScheduledWorkItem(const char *, const wq_config_t &);
    virtual ~ScheduledWorkItem();
    void ScheduleOnInterval(uint32_t interval_us);
    void ScheduleClear();
protected:
    virtual void Run() = 0;
};
}
template <class T> struct Kept { void store(T *); };
template <class T> class ModuleBase {
public:
    virtual ~ModuleBase() {}
    static int main(int argc, char *argv[]);
protected:
    static constexpr int task_id_is_work_queue = -2;
    static Kept<T> _object;
    static int _task_id;
    bool should_exit() const;
    static void exit_and_cleanup();
};
namespace matrix {
template <class T> struct Quaternion { explicit Quaternion(const T *); };
template <class T> struct Euler { explicit Euler(const Quaternion<T> &); T theta() const; };
using Quatf = Quaternion<float>;
using Eulerf = Euler<float>;
}
