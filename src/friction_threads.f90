!> Whether threads should share the points of a batch.
module friction_threads
    use, intrinsic :: iso_c_binding, only : c_int
    use, intrinsic :: iso_fortran_env, only : int64
    implicit none
    private

    public :: worth_threads

    interface
        !> See friction_fork.c.
        function in_forked_process() result(forked) bind(C, name='stickslip_in_forked_process')
            import :: c_int
            implicit none
            integer(c_int) :: forked   !! 0 if this is the process that loaded the library
        end function in_forked_process
    end interface

contains

    !> Few points are done before threads are called. In a forked process there are none: OpenMP
    !> would wait for those of the parent, for ever.
    function worth_threads(points, few)
        integer(int64), intent(in) :: points
        integer, intent(in) :: few   !! points that are not worth a second thread
        logical :: worth_threads

        worth_threads = points >= few
        if (worth_threads) worth_threads = in_forked_process() == 0
    end function worth_threads

end module friction_threads
