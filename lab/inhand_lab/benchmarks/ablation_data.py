"""What an ablation learns from and tests."""

from dataclasses import dataclass

from inhand_tracker.model.model import Model

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import Fold, leave_one_out, train_on_one_test_on_other


@dataclass(frozen=True)
class AblationData:
    """The data of an ablation: one participant of ``trained`` is left out at a time, or all of
    ``tested`` is tested. ``plain`` are the same people without their variety, where given."""

    trained: Dataset
    tested: Dataset | None = None
    plain: Dataset | None = None
    images: bool = True

    def folds(self) -> list[Fold]:
        """Return the folds; raises DatasetError."""
        if self.tested is None:
            return leave_one_out(self.trained)
        return train_on_one_test_on_other(self.trained, self.tested)


def learn_usually(data: AblationData, fold: Fold) -> Model:
    """Learn as ``inhand evaluate`` does; raises DatasetError or RecordingError."""
    return learn_fold_model(data.trained, fold, images=data.images, fused=True)


def learn_from_plain_people(data: AblationData, fold: Fold) -> Model:
    """Learn the same from people without variety; raises DatasetError or RecordingError."""
    if data.plain is None or data.tested is None:
        raise DatasetError("nobody without variety is given to learn from")
    folds = train_on_one_test_on_other(data.plain, data.tested)
    same = [other for other in folds if other.interaction == fold.interaction]
    if not same:
        raise DatasetError(f"{data.plain.folder} has no labelled recording of {fold.interaction}")
    return learn_fold_model(data.plain, same[0], images=data.images, fused=True)
