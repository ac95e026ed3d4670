C     A job with a material of the user's own beside friction, in fixed form.
C
C     The friction comes without the names that Abaqus looks for, from
C     stickslip_abaqus_standard_routines.f90, in a library or an object
C     of its own (abaqus make library=...), and is called from here.
C     FRIC and UINTER are free likewise: write routines that call
C     STICKSLIP_FRIC and STICKSLIP_UINTER, or none.
      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,
     1 RPL,DDSDDT,DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,
     2 PREDEF,DPRED,CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,
     3 DROT,PNEWDT,CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,JSTEP,KINC)
      IMPLICIT REAL*8(A-H,O-Z)
      CHARACTER*80 CMNAME
      DIMENSION STRESS(NTENS),STATEV(NSTATV),DDSDDE(NTENS,NTENS),
     1 DDSDDT(NTENS),DRPLDE(NTENS),STRAN(NTENS),DSTRAN(NTENS),TIME(2),
     2 PREDEF(1),DPRED(1),PROPS(NPROPS),COORDS(3),DROT(3,3),
     3 DFGRD0(3,3),DFGRD1(3,3),JSTEP(4)
C
      IF (CMNAME(1:8).EQ.'FRICTION') THEN
         CALL STICKSLIP_UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,
     1    RPL,DDSDDT,DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,
     2    PREDEF,DPRED,CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,
     3    DROT,PNEWDT,CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,JSTEP,
     4    KINC)
      ELSE
C        elastic without lateral contraction: modulus PROPS(1)
         DO J=1,NTENS
            DO I=1,NTENS
               DDSDDE(I,J)=0.D0
            END DO
            DDSDDE(J,J)=PROPS(1)
            IF (J.GT.NDI) DDSDDE(J,J)=0.5D0*PROPS(1)
            STRESS(J)=STRESS(J)+DDSDDE(J,J)*DSTRAN(J)
         END DO
      END IF
      RETURN
      END
