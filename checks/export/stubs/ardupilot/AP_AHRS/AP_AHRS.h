/* Not ArduPilot's header: our own declarations of names that its public documentation has. */
#pragma once
struct Vector3f { float x, y, z; };
class AP_AHRS {
public:
    float get_pitch_rad() const;
    const Vector3f &get_gyro() const;
};
namespace AP { AP_AHRS &ahrs(); }
