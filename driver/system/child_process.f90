!> Child processes that compute something and tell it to their parent, as a line of text through a
!> pipe. Processes and not threads: gfortran keeps lengths of character results in static memory, so
!> that text made by two threads at once gets mixed up; and a child that crashes harms no other.
module child_process
    use, intrinsic :: iso_c_binding, only : c_int, c_long, c_null_ptr, c_size_t
    use, intrinsic :: iso_fortran_env, only : error_unit, output_unit, real64
    use c_library, only : c_close, c_end, c_fork, c_getpid, c_getppid, c_kill, c_pipe, &
        c_poll, c_read, c_wait, c_waitpid, c_write
    use platform, only : interrupted, replace_program, seconds
    implicit none
    private

    public :: child, run_command, wait_for_one

    type :: child
        private
        integer(c_int) :: id = 0          !! of the process; 0: none is running
        integer(c_int) :: pipe_end = -1   !! the parent reads from it, the child writes to it
        integer(c_int) :: parent = 0      !! who started it
    contains
        procedure :: start, running, orphaned, tell_and_end
    end type child

contains

    !> Splits the process in two; `inside` tells which of them goes on here.
    subroutine start(self, inside, started)
        class(child), intent(inout) :: self
        logical, intent(out) :: inside    !! this is the child
        logical, intent(out) :: started   !! false: the system has no room for another process
        integer(c_int) :: ends(2), ignored

        inside = .false.
        started = c_pipe(ends) == 0
        if (.not. started) return
        flush (output_unit)
        flush (error_unit)
        self%parent = c_getpid()
        self%id = c_fork()
        inside = self%id == 0
        started = self%id >= 0
        self%pipe_end = ends(merge(2, 1, inside))
        ignored = c_close(ends(merge(1, 2, inside)))
        if (started) return
        self%id = 0
        ignored = c_close(self%pipe_end)
    end subroutine start

    elemental logical function running(self)
        class(child), intent(in) :: self

        running = self%id > 0
    end function running

    !> In the child: its parent has ended, nobody waits for what it is doing.
    logical function orphaned(self)
        class(child), intent(in) :: self

        orphaned = c_getppid() /= self%parent
    end function orphaned

    !> Hands one line of text to the parent, and ends the child.
    subroutine tell_and_end(self, text)
        class(child), intent(in) :: self
        character(len=*), intent(in) :: text
        integer(c_size_t) :: written, length

        length = len(text, c_size_t) + 1_c_size_t
        written = c_write(self%pipe_end, text // new_line('a'), length)
        call c_end(merge(0_c_int, 1_c_int, written == length))
    end subroutine tell_and_end

    !> Waits until one of the running children has ended, and takes what it has told.
    subroutine wait_for_one(children, which, text, sound)
        type(child), intent(inout) :: children(:)              !! all that there are
        integer, intent(out) :: which                          !! 0: none was left to wait for
        character(len=:), allocatable, intent(out) :: text
        logical, intent(out) :: sound                          !! false: it crashed
        character(len=4096) :: buffer
        integer(c_size_t) :: got
        integer(c_int) :: id, status, ignored
        integer :: i

        text = ''
        sound = .false.
        which = 0
        id = c_wait(status)
        if (id < 0) then   ! whoever started this process had endings of children go unreported
            which = findloc(children%running(), .true., dim=1)
            status = 0_c_int
        end if
        do i = 1, size(children)
            if (children(i)%running() .and. children(i)%id == id) which = i
        end do
        if (which == 0) return
        do
            got = c_read(children(which)%pipe_end, buffer, len(buffer, c_size_t))
            if (got <= 0) exit
            text = text // buffer(:got)
        end do
        ignored = c_close(children(which)%pipe_end)
        children(which)%id = 0
        sound = status == 0 .and. index(text, new_line('a')) > 0
        if (sound) text = text(:len(text) - 1)
    end subroutine wait_for_one

    !> Runs a command of the shell, and stops it after a time or when the user interrupts.
    subroutine run_command(command, limit, succeeded, in_time)
        character(len=*), intent(in) :: command
        real(real64), intent(in) :: limit    !! [s]
        logical, intent(out) :: succeeded
        logical, intent(out) :: in_time      !! it ended by itself
        integer(c_int), parameter :: no_wait = 1, sigkill = 9, pause = 20   ! [ms]
        character(len=max(2, len(command))) :: arguments(2)
        integer(c_int) :: id, status, ignored
        real(real64) :: begun

        arguments(1) = '-c'
        arguments(2) = command
        flush (output_unit)
        flush (error_unit)
        begun = seconds()
        succeeded = .false.
        in_time = .true.
        id = c_fork()
        if (id == 0) then
            call replace_program('/bin/sh', arguments)
            call c_end(127_c_int)   ! there is no shell
        end if
        if (id < 0) return
        do while (c_waitpid(id, status, no_wait) == 0)
            in_time = seconds() - begun < limit .and. .not. interrupted()
            if (.not. in_time) then
                ignored = c_kill(id, sigkill)
                ignored = c_waitpid(id, status, 0_c_int)
                return
            end if
            ignored = c_poll(c_null_ptr, 0_c_long, pause)
        end do
        succeeded = status == 0
    end subroutine run_command

end module child_process
