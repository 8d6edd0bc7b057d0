"""Results: arrays of numpy where it is installed, lists of floats elsewhere."""

from . import _kreisel

try:
    import numpy
except ImportError:
    numpy = None


def vector(numbers):
    """A list of numbers as an array, if numpy is there."""
    return list(numbers) if numpy is None else numpy.array(numbers, dtype=float)


def matrix(table):
    """A table of the compiled module, or rows of numbers, as an array if numpy is there."""
    if numpy is not None:
        return numpy.array(table, dtype=float)
    return table if isinstance(table, list) else memoryview(table).tolist()


def columns_of(rows, begin, count):
    """Some columns of the rows; one column is a vector."""
    if numpy is not None:
        return rows[:, begin] if count == 1 else rows[:, begin:begin + count]
    if count == 1:
        return [row[begin] for row in rows]
    return [row[begin:begin + count] for row in rows]


class Run:
    """A computed motion. Arrays are by output time, in SI units and radian."""

    title: str
    """Title of the scene."""
    model: str
    """exact, or the requested approximation."""
    columns: list
    """Names of the columns of rows."""

    def __init__(self, motion):
        self._rows = matrix(motion.rows)
        self._groups = {}
        for table, groups in ((self._rows, motion.groups), (None, motion.part_groups)):
            if table is None:
                table = matrix(motion.parts)
                if len(table) == 0:
                    continue
            for group in groups:
                values = columns_of(table, group.begin, group.count)
                kind = self._groups.setdefault(group.kind, {})
                if group.part:
                    kind.setdefault(group.name, {})[group.part] = values
                else:
                    kind[group.name] = values
        self.title, self.model, self.columns = motion.title, motion.model, motion.columns
        self._errors = vector(motion.errors)
        self._error_of_log = motion.error_of_log
        self._terms, self._report = motion.terms, motion.report

    @property
    def rows(self):
        """The numbers of simulate --csv."""
        return self._rows

    @property
    def times(self):
        """Output times, s."""
        return columns_of(self._rows, 0, 1)

    @property
    def coordinates(self):
        """By body: angle in rad or displacement in m; two angles; the attitude (w, x, y, z) against
        the parent, and of a free body its position in m."""
        return self._groups.get("coordinates", {})

    @property
    def rates(self):
        """By body: rad/s or m/s; angular velocity on body axes, and of a free body its velocity in
        m/s on the parent's axes."""
        return self._groups.get("rates", {})

    @property
    def reactions(self):
        """By body, on request: 'force' in N and 'torque' in N m of the parent at the joint, on body
        axes, and 'drive_torque' in N m."""
        return self._groups.get("reactions", {})

    @property
    def elements(self):
        """By element, on request: 'force' in N and 'torque' in N m on its second body, about its end
        there, on the first body's axes."""
        return self._groups.get("elements", {})

    @property
    def constraints(self):
        """By constraint, on request: 'force' in N and 'torque' in N m on its second body, about its
        point, on the first body's axes."""
        return self._groups.get("constraints", {})

    @property
    def sensors(self):
        """By sensor a dict of its parts: 'value', with errors also 'true'; of a point 'position',
        'velocity', 'acceleration'; of a reaction 'force', 'torque'."""
        return self._groups.get("sensors", {})

    @property
    def parts(self):
        """By body, with terms=True: 'relative', 'guide' and 'coriolis' part of the law, each force in
        N and torque in N m about the body's origin, on body axes."""
        return self._groups.get("parts", {})

    @property
    def errors(self):
        """Estimates of the global error over time; Report.error_estimate is the greatest."""
        return self._errors

    @property
    def error_of_log(self):
        """Effect of the errors of logs on the end, in the measure of Report.error_estimate; 0 without
        logs."""
        return self._error_of_log

    @property
    def terms(self):
        """Terms of the exact equation, kept and dropped."""
        return self._terms

    @property
    def report(self):
        """Error and cost of the run."""
        return self._report

    def __repr__(self):
        report = self._report
        kept = "" if report.tolerance_kept else ", tolerance MISSED"
        title = f"{self.title!r}, " if self.title else ""
        return (f"<kreisel.Run {title}{len(self._rows)} rows to t = {self._rows[-1][0]:.9g} s, "
                f"{report.method}, error {report.error_estimate:.1e}{kept}>")


class Ensemble:
    """The members of an ensemble. Arrays have a row for each member."""

    def __init__(self, members):
        self._members = members
        self._varied, self._ends = matrix(members.varied), matrix(members.ends)
        self._errors = vector(members.errors)

    @property
    def keys(self):
        """Keys of the varied numbers: the columns of varied."""
        return self._members.keys

    @property
    def columns(self):
        """Names of joints and sensors: the columns of ends."""
        return self._members.columns

    @property
    def varied(self):
        """The numbers of each member, in the units of the scene."""
        return self._varied

    @property
    def ends(self):
        """The end of each motion, SI units and radian; NaN for members that failed."""
        return self._ends

    @property
    def errors(self):
        """The error estimate of each member, as Report.error_estimate."""
        return self._errors

    @property
    def messages(self):
        """For each member the reason why it failed; empty if it is complete."""
        return self._members.messages

    @property
    def missed(self):
        """Number of members that did not reach the tolerance."""
        return self._members.missed

    @property
    def failed(self):
        """Number of members that failed."""
        return sum(1 for message in self._members.messages if message)

    def __len__(self):
        return len(self._members.messages)

    def __repr__(self):
        return (f"<kreisel.Ensemble of {len(self)} members, {self.failed} failed, "
                f"{self.missed} missed the tolerance, varied: {', '.join(self.keys)}>")
