-- Stands for what ArduPilot offers a script: only the names that the exported script asks for, with their kinds of answers.

local world = {
    now = 0, delay_ms = 0, pitch_rad = 0.0, rate_rad_s = 0.0,
    values = {}, told = {}, moved = 0, servo = nil, servo_function = nil,
}

-- A whole number of 32 bits that is no plain number, as that of millis() is none.
local whole = {}
whole.__index = whole
local function wrapped(value) return setmetatable({ value = value }, whole) end
local function plain(value) return type(value) == "table" and value.value or value end
whole.__add = function(left, right) return wrapped(plain(left) + plain(right)) end
whole.__sub = function(left, right)
    local difference = plain(left) - plain(right)
    assert(difference >= 0, "it would wrap")
    return wrapped(difference)
end
function whole:toint() return self.value end

function millis() return wrapped(world.now) end

ahrs = {}
function ahrs:get_pitch() return world.pitch_rad end
function ahrs:get_gyro() return { y = function() return world.rate_rad_s end } end

gcs = {}
function gcs:send_text(severity, text)
    assert(math.type(severity) == "integer" and severity <= 7)
    assert(#text <= 50, "longer than a message is")
    table.insert(world.told, text)
end

SRV_Channels = {}
function SRV_Channels:set_output_norm(servo_function, value)
    assert(math.type(servo_function) == "integer" and value >= -1 and value <= 1)
    world.moved, world.servo, world.servo_function = world.moved + 1, value, servo_function
end

param = {}
function param:add_table(key, prefix, count)
    assert(math.type(key) == "integer" and key >= 0 and key <= 200 and count <= 63)
    self.prefix, self.count = prefix, count
    return true
end
function param:add_param(key, place, name, default)
    assert(math.type(place) == "integer" and place >= 1 and place <= self.count)
    assert(#self.prefix + #name <= 16, name)
    world.values[self.prefix .. name] = default
    return true
end

function Parameter()
    local bound = {}
    function bound:init(name)
        self.name = name
        return world.values[name] ~= nil
    end
    -- Parameters are reals.
    function bound:get() return world.values[self.name] + 0.0 end
    return bound
end

local update, wait_ms = dofile("pitch_ardupilot.lua")

-- So many turns, each when it is due and as much later as is wanted.
function world.run(turns)
    for _ = 1, turns do
        assert(math.type(wait_ms) == "integer" and wait_ms >= 1, wait_ms)
        world.now = world.now + wait_ms + world.delay_ms
        update, wait_ms = update()
    end
end

local degrees = string.find(io.open("pitch.lua"):read("a"), "measurement_deg") ~= nil

-- What the module is to be given.
function world.sample(setpoint_deg)
    if degrees then
        return {
            setpoint_deg = setpoint_deg + 0.0, measurement_deg = math.deg(world.pitch_rad),
            rate_deg_s = math.deg(world.rate_rad_s),
        }
    end
    return { setpoint_rad = math.rad(setpoint_deg), measurement_rad = world.pitch_rad, rate_rad_s = world.rate_rad_s }
end

function world.command_deg(answer)
    return degrees and answer.command_deg or math.deg(answer.command_rad)
end

return world
