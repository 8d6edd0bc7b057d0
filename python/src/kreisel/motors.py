"""Motors (screws, spatial vectors): velocities, forces, momenta and inertia, for teaching.

    from kreisel.motors import Motor, Rate, Velocity, cross, reciprocal
    drill = Motor([0, 0, 100], [200, 100, -0.02])      # rad/s; m/s at the point of reduction
    drill.axis_point, drill.pitch                      # m, m/rad

A Motor is (resultant; moment at a point). Axes and point are yours. Velocity and Rate carry the names
of their frames and observers, and refuse operations that do not fit. The library's C++ types do the
same at compile time.
"""

from ._errors import InvalidInput
from ._kreisel import (Inertia, Motor, MotorTensor, Pose, cross, dyad, exp, log, parts_of_the_law,
                       reciprocal)

__all__ = ["Inertia", "Motor", "MotorTensor", "Pose", "Rate", "Velocity", "cross", "dyad",
           "equation_of_motion", "exp", "log", "reciprocal"]


class Velocity:
    """The velocity of the frame `of` against the frame `against`, written in `written_in`.

    motor is (angular velocity in rad/s; velocity in m/s of the point of `of` at the origin of
    `written_in`), on the axes of `written_in`, which is `of` by default.

        Velocity("body", "ship", V) + Velocity("ship", "earth", F)    # of the body against the earth
    """

    __slots__ = ("of", "against", "motor", "written_in")

    def __init__(self, of, against, motor, *, written_in=None):
        self.of, self.against, self.motor = of, against, motor
        self.written_in = of if written_in is None else written_in

    def __add__(self, other):
        self._fits(other)
        if self.against != other.of:
            raise InvalidInput(f"velocities add along a chain of frames: {self} ends at "
                               f"{self.against!r}, {other} begins at {other.of!r}")
        return self._of(self.of, other.against, self.motor + other.motor)

    def __neg__(self):
        return self._of(self.against, self.of, -self.motor)

    def __sub__(self, other):
        return self + -other

    def __repr__(self):
        return f"Velocity of {self.of!r} against {self.against!r} in {self.written_in!r}"

    def _of(self, of, against, motor):
        return Velocity(of, against, motor, written_in=self.written_in)

    def _fits(self, other):
        if self.written_in != other.written_in:
            raise InvalidInput(f"{self} and {other} are not written in one frame")


class Rate:
    """The time derivative of a Velocity as an observer in the frame `observer` sees it.

    motor is (rad/s^2; m/s^2), written where the velocity is written. The derivative is a motor: its
    moment belongs to the instantaneous origin of that frame.
    """

    __slots__ = ("observer", "quantity", "motor")

    def __init__(self, observer, quantity, motor):
        self.observer, self.quantity, self.motor = observer, quantity, motor

    def seen_from(self, observer, velocity):
        """The rate for another observer: this rate less [V Q].

        velocity is that of the new observer against this one. Raises InvalidInput if it is another.
        """
        self.quantity._fits(velocity)
        if (velocity.of, velocity.against) != (observer, self.observer):
            raise InvalidInput(f"from {self.observer!r} to {observer!r} leads the velocity of "
                               f"{observer!r} against {self.observer!r}, not the {velocity}")
        return Rate(observer, self.quantity, self.motor - cross(velocity.motor, self.quantity.motor))

    def __repr__(self):
        return f"Rate of ({self.quantity}) seen from {self.observer!r}"


def equation_of_motion(inertia, relative, guide, relative_rate, guide_rate):
    """The parts of the force on a body, by the nine forms of paper 002; returns a dict of Motors.

    inertia        Inertia, on body axes about the body's origin, kg, m, kg m^2
    relative       Velocity of the body against the guide, written in the body
    guide          Velocity of the guide against the inertial frame, written in the body
    relative_rate  Rate of `relative`; its observer and that of `guide_rate` choose the form
    guide_rate     Rate of `guide`

    Keys: relative, guide, coriolis, each (force in N; torque in N m about the body's origin), and
    total. Raises InvalidInput if frames or observers do not fit.
    """
    relative._fits(guide)
    if relative.against != guide.of or relative.written_in != relative.of:
        raise InvalidInput(f"{relative} and {guide} are no relative and guide velocity in the body")
    observers = {relative.of: 0, relative.against: 1, guide.against: 2}
    for rate, velocity in ((relative_rate, relative), (guide_rate, guide)):
        if (rate.quantity.of, rate.quantity.against) != (velocity.of, velocity.against):
            raise InvalidInput(f"{rate} is no rate of the {velocity}")
        if rate.observer not in observers:
            raise InvalidInput(f"the observer of {rate} is none of {', '.join(observers)}")
    parts = parts_of_the_law(inertia, relative.motor, guide.motor,
                             observers[relative_rate.observer], relative_rate.motor,
                             observers[guide_rate.observer], guide_rate.motor)
    named = dict(zip(("relative", "guide", "coriolis"), parts))
    return {**named, "total": parts[0] + parts[1] + parts[2]}


for _name in ("Inertia", "Motor", "MotorTensor", "Pose"):
    globals()[_name].__module__ = "kreisel.motors"
