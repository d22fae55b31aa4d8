-- Runs the pitch controller `@PREFIX@` on ArduPilot: reads the attitude, moves one servo output, every @PERIOD@ ms.
--
-- This file goes into APM/scripts on the card, @PREFIX@.lua into APM/scripts/modules; SCR_ENABLE is 1. The output to move
-- has SERVOn_FUNCTION 94 (Script 1); SERVOn_TRIM is its middle, SERVOn_REVERSED its direction: nose up is positive.
-- Nothing moves before @PARAMETERS@ENABLE is 1.
--
-- What it does NOT do:
--   arming: it runs armed or not, and arms and disarms nothing;
--   failsafe: it does not see lost links, batteries, fences or a bad attitude, and hands nothing over;
--   modes and sticks: it knows no flight mode and no pilot; the set-point is a parameter;
--   ArduPilot's own pitch control: that goes on beside it, on outputs of its own functions;
--   hard timing: scripts run when there is time for them; a sample that is late by a period is told and not made up for;
--   turning flight: the pitch rate is that of the gyro, which is that of the pitch angle with level wings alone.
-- A script that fails stops, and the output stays where it was last put.

local controller = require("@PREFIX@")

-- One script's own, from 0 to 200; choose another where another script has it.
local TABLE_KEY = @KEY@
local PARAMETERS = "@PARAMETERS@"
local PERIOD_MS = @PERIOD@
local IDLE_MS = 200
local WARNING, INFORMATION = 4, 6

local function tell(severity, text)
    gcs:send_text(severity, "@PREFIX@: " .. text)
end

assert(param:add_table(TABLE_KEY, PARAMETERS, 4), "@PREFIX@: another script has parameter table @KEY@")

local function parameter(place, name, default)
    assert(param:add_param(TABLE_KEY, place, name, default), "@PREFIX@: no parameter " .. name)
    local bound = Parameter()
    assert(bound:init(PARAMETERS .. name), "@PREFIX@: no parameter " .. name)
    return bound
end

-- 1 moves the output; anything else forgets everything and lets the output alone.
local enable = parameter(1, "ENABLE", 0)
-- The function of the output; 94 is Script 1.
local servo = parameter(2, "SERVO", 94)
-- Commanded pitch in degrees, nose up positive.
local setpoint_deg = parameter(3, "SETPT_DEG", 0)
-- The command in degrees that is full throw of the servo@THROW_SOURCE@.
local throw_deg = parameter(4, "THROW_DEG", @THROW@)

local state, sample, answer = {}, {}, {}
local running, due = false, nil
local told_faults, late, late_to_tell = 0, 0, 1

local function begin()
    controller.reset(controller.design, state)
    running, due = true, millis()
    told_faults, late, late_to_tell = 0, 0, 1
    tell(INFORMATION, "runs")
end

local function stop(text)
    if running then tell(WARNING, text) end
    running = false
end

local function step(full_throw_deg)
    @SAMPLE@
    controller.step(controller.design, state, sample, answer)
    local part = @COMMAND@ / full_throw_deg
    if part > 1.0 then part = 1.0 elseif part < -1.0 then part = -1.0 end
    SRV_Channels:set_output_norm(math.floor(servo:get()), part)
    if answer.faults ~= told_faults then
        told_faults = answer.faults
        tell(WARNING, string.format("faults %d", told_faults))
    end
end

-- How long to wait: samples are a period apart from when they were due, so that delays do not add up.
local function waiting()
    local now = millis()
    local behind_ms = (now - due):toint()
    if behind_ms < PERIOD_MS then
        due = due + PERIOD_MS
        return PERIOD_MS - behind_ms
    end
    due = now + PERIOD_MS
    late = late + 1
    if late == late_to_tell then
        late_to_tell = 10 * late_to_tell
        tell(WARNING, string.format("late %d times", late))
    end
    return PERIOD_MS
end

local function update()
    if enable:get() ~= 1 then
        stop("is switched off")
        return update, IDLE_MS
    end
    local full_throw_deg = throw_deg:get()
    if not (full_throw_deg > 0.0) then
        stop(PARAMETERS .. "THROW_DEG is to be positive")
        return update, IDLE_MS
    end
    if not running then begin() end
    step(full_throw_deg)
    return update, waiting()
end

tell(INFORMATION, "waits for " .. PARAMETERS .. "ENABLE")
return update, IDLE_MS
