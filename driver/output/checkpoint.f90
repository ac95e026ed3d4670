!> Checkpoints: all that a run needs to go on as if it had never stopped, in one file. They are
!> written now and then, and when the run is interrupted.
module checkpoint
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use archive_file, only : archive
    use platform, only : interrupted, seconds
    use recorder, only : csv_recorder
    use run_observer, only : observer, step_news
    use run_settings, only : settings
    use simulation, only : simulation_run
    use slider_system, only : slider_state
    implicit none
    private

    public :: checkpoint_writer, read_checkpoint

    integer(int64), parameter :: version = int(z'737469636B73000F', int64)   !! "sticks", and 15

    type, extends(observer) :: checkpoint_writer
        character(len=:), allocatable :: name
        type(settings), pointer :: run => null()
        type(simulation_run), pointer :: live => null()
        type(csv_recorder), pointer :: records => null()   !! must see each step before
        real(dp) :: last = 0.0_dp                          !! the clock at the last one [s]
    contains
        procedure :: see
        procedure, private :: write_now
    end type checkpoint_writer

contains

    subroutine see(self, old, new, news)
        class(checkpoint_writer), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news
        integer, parameter :: steps_between_looks = 64

        if (interrupted()) then
            call self%write_now()
            news%interrupted = .true.
            call news%stop_run('interrupted; stickslip run with --resume goes on from here')
        else if (len(news%problem) > 0) then
            call self%write_now()
        else if (mod(news%steps, steps_between_looks) == 0) then
            if (seconds() - self%last < self%run%checkpoint) return
            call self%write_now()
            self%last = seconds()
        end if
    end subroutine see

    !> Leaves the checkpoint before in place if this one cannot be written.
    subroutine write_now(self)
        class(checkpoint_writer), intent(inout) :: self
        type(archive) :: file
        logical :: done

        call self%records%flush_all()
        if (self%records%failed()) return
        call file%create(self%name, version)
        call file%visit(self%run%fingerprint)
        call visit_all(file, self%live, self%records)
        call file%close(done)
    end subroutine write_now

    !> Carries a run that has just been started, and its files, to where the checkpoint was written.
    !> `problem` says why it cannot go on from there.
    subroutine read_checkpoint(name, run, live, records, problem)
        character(len=*), intent(in) :: name
        type(settings), intent(in) :: run
        type(simulation_run), intent(inout) :: live
        type(csv_recorder), intent(inout) :: records
        character(len=:), allocatable, intent(out) :: problem
        type(archive) :: file
        integer(int64) :: fingerprint
        logical :: done

        call file%open(name, version, problem)
        if (len(problem) > 0) return
        call file%visit(fingerprint)
        if (fingerprint /= run%fingerprint) then
            problem = 'the input is not the one that wrote the checkpoint ' // name
        else
            call visit_all(file, live, records)
            live%resumed = .true.
        end if
        call file%close(done)
        if (len(problem) == 0 .and. .not. done) problem = name // ' is shorter than it should be'
    end subroutine read_checkpoint

    subroutine visit_all(file, live, records)
        type(archive), intent(inout) :: file
        type(simulation_run), intent(inout) :: live
        type(csv_recorder), intent(inout) :: records

        call live%visit(file)
        call records%visit(file)
    end subroutine visit_all

end module checkpoint
