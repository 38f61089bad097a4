"""Contact of elastic bodies by domain decomposition: a model in Python, solved by contact-dd-mpi.

    import contact_dd

    model = contact_dd.Model.from_mesh("blocks.msh", plane="strain")
    model.body("blocks", contact_dd.Material(young=5.2e9, poisson=0.18))
    model.fix("bottom")
    model.load("top", pressure=1e6)
    model.contact("joint, upper side", "joint, lower side", friction=0.5)
    result = model.run(ranks=2)
    result.plot()
"""

from contact_dd.adaptivity import adapt
from contact_dd.comparison import Compared, compare
from contact_dd.errors import ContactError, IllPosed, InputError, NotConverged, OutputError, Stopped
from contact_dd.model import Material, Model, Step
from contact_dd.result import Result
from contact_dd.study import Study

__all__ = [
    "Compared", "ContactError", "IllPosed", "InputError", "Material", "Model", "NotConverged", "OutputError", "Result",
    "Step", "Stopped", "Study", "adapt", "compare",
]
