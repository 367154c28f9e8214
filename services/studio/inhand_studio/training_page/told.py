"""What a page says of a training."""

from collections.abc import Iterator

from inhand_studio.training_page.training import Progress


def progress_lines(progress: Progress) -> Iterator[str]:
    """Say how far a training is, and how exact what it learned is."""
    if progress.running:
        yield f"{progress.title}: {progress.doing} …"
        for stage, (done, total) in progress.steps.items():
            if done < total:
                yield f"{stage}: {done} of {total}"
        finished = sum(done >= total for done, total in progress.steps.values())
        if finished:
            yield f"{finished} stages done"
    if progress.model is not None:
        yield f"learned: {progress.model}"
    if progress.error is not None:
        error = progress.error
        yield (
            f"on a participant who was left out: vertex error {error['vertex_error_cm']:.1f} cm "
            f"(± {error['sd']:.1f})"
        )
        for one in error["interactions"].values():
            yield (
                f"translation {one['translation_cm']:.1f} cm, rotation {one['rotation_deg']:.0f}°"
            )
