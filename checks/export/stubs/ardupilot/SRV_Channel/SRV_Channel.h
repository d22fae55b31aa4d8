/* Not ArduPilot's header: our own declarations of names that its public documentation has. */
#pragma once
struct SRV_Channel { enum Function { k_elevator = 19 }; };
struct SRV_Channels { static void set_output_scaled(SRV_Channel::Function function, float value); };
