"""The law of law.c as PythonFMU, a tool of others, makes an FMU of it: names of its own, elevator down positive."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Law(Fmi2Slave):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.theta_ref = 0.0
        self.theta = 0.0
        self.q = 0.0
        self.delta_e = 0.0
        for name in ("theta_ref", "theta", "q"):
            self.register_variable(Real(name, causality=Fmi2Causality.input, variability=Fmi2Variability.continuous))
        self.register_variable(Real("delta_e", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        self.delta_e = -(0.8 * (self.theta_ref - self.theta) - 0.1 * self.q)
        return True
